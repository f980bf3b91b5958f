// QuadricChannels: the feature values that contribute to the cost. Private to render/reduce.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/base/huge_array.h"

namespace merlin::render::reduce {

// Stores one block of floats per vertex: a, then (b x, b y, b z, s) for each channel, with a, b and
// s as defined in quadric_evaluate.h. The unit of length is the mean edge length.
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
  // Prefetches the block of a vertex that will be read soon into the cache.
  void prefetch(std::uint32_t v) const noexcept {
    constexpr std::size_t kCacheLine = 64 / sizeof(float);
    const float* const first = block(v);
    for (const float* at = first; at < first + stride(); at += kCacheLine) __builtin_prefetch(at);
  }
  float& value(std::uint32_t v, std::size_t channel) const noexcept {
    return block(v)[4 + 4 * channel];
  }

  // Sets the range of a channel's values: `given` in the caller's unit, `weighted` as stored in the
  // blocks. Values at new vertices are clamped to it.
  void setRange(std::size_t channel, const Range& given, const Range& weighted) {
    given_[channel] = given;
    weighted_[channel] = weighted;
  }

  // Computes the best channel values for the vertex into which v and x merge, and stores them in
  // both blocks. `p`: position of the merged vertex relative to v. `q`: its position relative to x.
  void mix(std::uint32_t v, std::uint32_t x, const float (&p)[3], const float (&q)[3]) const;

  // Returns the value of a channel at v in the caller's unit: the stored value divided by `weight`,
  // clamped to the given range. If the quotient is NaN, because the feature's values are extremely
  // large or small, returns the lowest given value.
  float given(std::uint32_t v, std::size_t channel, float weight) const noexcept;

 private:
  std::size_t count_ = 0;
  HugeArray<float> blocks_;
  std::vector<Range> given_, weighted_;
};

}  // namespace merlin::render::reduce
