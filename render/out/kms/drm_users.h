// Finds the programs, and the descriptors of this process, that have a card's device file open.
#pragma once

#include <string>
#include <vector>

namespace merlin::render::out::kms {

// Returns the programs that have the file open, each as "Xorg (812)" with its process id, except
// this process and its parent. Without root's rights, some may not be found.
std::vector<std::string> programsWith(const std::string& path);

// Gives up being DRM master on this process's other descriptors of the card. Mesa's software
// renderer opens the card too, and is master if it was the first; it does not need to be.
void dropMasterElsewhere(const std::string& path, int fd);

}  // namespace merlin::render::out::kms
