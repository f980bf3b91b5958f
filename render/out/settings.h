// What the configuration says of outputs.
#pragma once

#include <string>

namespace merlin::render {

struct PngSinkSettings {
  std::string path;        // empty: none
  double interval_s = 60;  // between two files, at least
};

}  // namespace merlin::render
