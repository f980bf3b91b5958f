#include "nn/inputs.h"

#include <algorithm>
#include <cassert>

namespace merlin::nn {

const std::array<const char*, kInputs> kInputNames = {
    "thumb-roll", "thumb-mcp",   "thumb-ip",   "thumb-abduction",
    "index-mcp",  "index-pip",   "index-dip",  "index-abduction",
    "middle-mcp", "middle-pip",  "middle-dip", "middle-index-abduction",
    "ring-mcp",   "ring-pip",    "ring-dip",   "ring-middle-abduction",
    "pinky-mcp",  "pinky-pip",   "pinky-dip",  "pinky-ring-abduction",
    "palm-arch",  "wrist-pitch", "wrist-yaw"};

const InputRanges kGloveRanges = {{
    {0.0F, 0.4F}, {0.0F, 0.9F},  {0.0F, 0.8F},  {0.2F, 0.5F},   // thumb
    {0.0F, 1.5F}, {0.0F, 1.7F},  {0.0F, 1.3F},  {-0.2F, 0.2F},  // index
    {0.0F, 1.5F}, {0.0F, 1.7F},  {0.0F, 1.3F},  {-0.2F, 0.2F},  // middle
    {0.0F, 1.5F}, {0.0F, 1.7F},  {0.0F, 1.3F},  {0.0F, 0.27F},  // ring
    {0.0F, 1.5F}, {0.0F, 1.7F},  {0.0F, 1.3F},  {-0.2F, 0.5F},  // pinky
    {0.0F, 0.5F}, {-0.7F, 0.9F}, {-0.5F, 0.3F},                 // palm, wrist
}};

Input normalise(const InputRanges& ranges, const Angles& value) noexcept {
  Input x;
  for (std::size_t i = 0; i < kInputs; ++i) {
    const auto [low, high] = ranges[i];
    assert(low < high);
    x[i] = std::clamp((value[i] - low) / (high - low), 0.0F, 1.0F);
  }
  return x;
}

}  // namespace merlin::nn
