// Finds the companion files that a model names.
#pragma once

#include <string>

namespace merlin::render::import {

// Returns the path of the file that a model in `folder` calls `name`: the name as it is written or,
// if there is no such file, decoded as a URI, in which "%20" is a blank. Neither can leave the
// folder, since both pass through pathBeside() of render/mesh/io.
std::string companionPath(const std::string& folder, const std::string& name);

}  // namespace merlin::render::import
