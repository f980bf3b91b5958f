// Who has a card open.
#pragma once

#include <string>
#include <vector>

namespace merlin::render::out::kms {

// Programs that have the file open, "Xorg (812)", except this one and its parent. A process that is
// not root's may not see all of them.
std::vector<std::string> programsWith(const std::string& path);

// Gives up being DRM master on this process's other descriptors of the card. Mesa's software
// renderer opens the card too, and is master if it was the first; it does not need to be.
void dropMasterElsewhere(const std::string& path, int fd);

}  // namespace merlin::render::out::kms
