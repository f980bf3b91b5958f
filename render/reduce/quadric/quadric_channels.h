// QuadricChannels: the feature values that contribute to the cost. Private to render/reduce.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/base/huge_array.h"

namespace merlin::render::reduce {

// One block per vertex: a, then (b x, y, z, s) for each channel (quadric_evaluate.h). Unit of
// length: mean edge length.
class QuadricChannels {
 public:
  struct Range {
    float low, high;
  };

  QuadricChannels() = default;
  QuadricChannels(std::size_t vertices, std::size_t channels)
      : count_(channels),
        blocks_(channels ? vertices * stride() : 0),
        given_(channels),
        weighted_(channels) {}

  std::size_t count() const noexcept { return count_; }
  std::size_t stride() const noexcept { return 1 + 4 * count_; }
  float* block(std::uint32_t v) const noexcept { return blocks_.data() + v * stride(); }
  // Loads the record of a vertex that will soon be read into the cache.
  void prefetch(std::uint32_t v) const noexcept {
    constexpr std::size_t kCacheLine = 64 / sizeof(float);
    const float* const first = block(v);
    for (const float* at = first; at < first + stride(); at += kCacheLine) __builtin_prefetch(at);
  }
  float& value(std::uint32_t v, std::size_t channel) const noexcept {
    return block(v)[4 + 4 * channel];
  }

  // Sets the range of a channel's values, as given and weighted; values at new vertices stay in it.
  void setRange(std::size_t channel, const Range& given, const Range& weighted) {
    given_[channel] = given;
    weighted_[channel] = weighted;
  }

  // Sets the values of v and x to the best ones for the vertex that they merge into, which is at
  // `p` relative to v and at `q` relative to x.
  void mix(std::uint32_t v, std::uint32_t x, const float (&p)[3], const float (&q)[3]) const;

  // Returns the value of v, divided by `weight`, within the given range. If a feature is so large
  // or so small that weighting makes its values NaN, returns the lowest given value.
  float given(std::uint32_t v, std::size_t channel, float weight) const noexcept;

 private:
  std::size_t count_ = 0;
  HugeArray<float> blocks_;
  std::vector<Range> given_, weighted_;
};

}  // namespace merlin::render::reduce
