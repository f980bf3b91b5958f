// What the tests of nn share: the shapes that the shipped network was trained on, and its file.
#pragma once

#include <string>
#include <vector>

#include "drivers/hand/shapes.h"
#include "nn/io/network_file.h"
#include "nn/synthetic.h"

namespace merlin::nn::test {

inline const std::string kShippedPath = MERLIN_SOURCE_DIR "/config/postures.json";

inline std::vector<HandShape> shippedShapes() {
  std::vector<HandShape> shapes;
  for (const hand::Shape& shape : hand::shapes()) shapes.push_back({shape.name, shape.angle_rad});
  return shapes;
}

// The network of config/postures.json; the default one, which names nothing, if it does not load.
inline PostureNetwork shippedNetwork() {
  const auto file = loadNetwork(kShippedPath);
  return file ? file->network : PostureNetwork{};
}

}  // namespace merlin::nn::test
