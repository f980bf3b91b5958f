// Shared by the tests of nn: the shipped network's file, and synthetic people.
#pragma once

#include <string>

#include "drivers/hand/recording.h"
#include "nn/io/network_file.h"

namespace merlin::nn::test {

inline const std::string kShippedPath = MERLIN_SOURCE_DIR "/config/postures.json";

// Returns the network of config/postures.json, or an empty network (no postures) if the file cannot
// be loaded.
inline PostureNetwork shippedNetwork() {
  const auto file = loadNetwork(kShippedPath);
  return file ? file->network : PostureNetwork{};
}

inline DataSet people(std::span<const hand::Shape> shapes, std::size_t first, std::size_t count,
                      std::size_t per_take, std::uint64_t seed, std::size_t takes = 1) {
  DataSet hands;
  hand::RecordingSettings settings;
  settings.first_person = first;
  settings.people = count;
  settings.takes = takes;
  settings.per_take = per_take;
  for (const hand::Shot& shot : hand::record(shapes, settings, seed))
    hands.push_back({shot.shape, shot.angle_rad});
  return hands;
}

}  // namespace merlin::nn::test
