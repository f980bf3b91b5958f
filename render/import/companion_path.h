// Finds the companion files that a model refers to.
#pragma once

#include <string>

#include "render/mesh/io/companion_files.h"

namespace merlin::render::import {

// Returns the path of the file that a model in `folder` calls `name`: the name as it is written or,
// if there is no such file, the name decoded as a URI, in which "%20" is a blank. No name can lead
// out of the folder, since both pass through pathBeside() of render/mesh/io.
std::string companionPath(const std::string& folder, const std::string& name);

// Does the same, but also accepts names that differ from the file's in upper and lower case, as
// `files` finds them.
std::string companionPath(mesh::CompanionFinder& files, const std::string& name);

}  // namespace merlin::render::import
