// Where a file lies that a model names.
#pragma once

#include <string>

namespace merlin::render::import {

// The path of the file that a model in `folder` calls `name`: as it is written or, where there is
// no such file, as a URI, in which "%20" is a blank. Neither leaves the folder: pathBeside() of
// render/mesh/io judges both.
std::string companionPath(const std::string& folder, const std::string& name);

}  // namespace merlin::render::import
