// BucketQueue: vertices by the cost of their best edge, roughly sorted. Private to render/reduce.
//
// A bucket holds the costs of one binary exponent and the same upper bits of the mantissa (1.6 %
// apart). Lists run through one number a vertex; nothing is ever moved or taken out: what a
// collapse made stale is measured again when it comes up. O(1) for each operation.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace merlin::render {

// `Next` is a callable: std::uint32_t& (std::uint32_t vertex), the vertex' link.
class BucketQueue {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  BucketQueue() : first_(kBuckets, kNone), filled_(kBuckets / 64, 0) {}

  // Least cost that does not belong to a later bucket.
  static float floorOf(std::size_t bucket) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(bucket + kLowest) << kDropped);
  }
  static std::size_t bucketOf(float cost) {
    const std::int64_t k = std::int64_t{std::bit_cast<std::uint32_t>(cost) >> kDropped} - kLowest;
    return static_cast<std::size_t>(std::clamp<std::int64_t>(k, 0, kBuckets - 1));
  }
  static constexpr std::size_t buckets() { return kBuckets; }

  // REQUIRES: cost > 0, vertex is in no bucket.
  template <typename Next>
  void push(std::uint32_t vertex, float cost, const Next& next) {
    const std::size_t k = bucketOf(cost);
    next(vertex) = first_[k];
    first_[k] = vertex;
    filled_[k / 64] |= std::uint64_t{1} << (k % 64);
    current_ = std::min(current_, k);
  }

  // From the first bucket that is not empty, if it is before `limit`; else kNone.
  template <typename Next>
  std::uint32_t pop(std::size_t limit, const Next& next) {
    const std::size_t k = filledFrom(current_);
    if (k == kBuckets) return kNone;
    current_ = k;
    if (k >= limit) return kNone;
    const std::uint32_t vertex = first_[k];
    first_[k] = next(vertex);
    if (first_[k] == kNone) filled_[k / 64] &= ~(std::uint64_t{1} << (k % 64));
    return vertex;
  }

  // Takes over what `other` holds: O(that).
  template <typename Next>
  void join(BucketQueue&& other, const Next& next) {
    for (std::size_t k = other.filledFrom(0); k < kBuckets; k = other.filledFrom(k + 1)) {
      std::uint32_t last = other.first_[k];
      while (next(last) != kNone) last = next(last);
      next(last) = first_[k];
      first_[k] = other.first_[k];
      filled_[k / 64] |= std::uint64_t{1} << (k % 64);
    }
    current_ = std::min(current_, other.current_);
    other = BucketQueue();
  }

  // The bucket that the last pop() looked at; a lower one after a push() there.
  std::size_t current() const noexcept { return current_; }

  static constexpr std::size_t kAhead = 5;

  // Those that pop() would return next, then kNone. What push() has put between them since the last
  // call may be missing.
  template <typename Next>
  const std::array<std::uint32_t, kAhead>& peek(const Next& next) {
    const std::size_t bucket = filledFrom(current_);
    const std::uint32_t front = bucket == kBuckets ? kNone : first_[bucket];
    if (front == ahead_[0]) return ahead_;
    std::size_t known = 1;
    if (front == ahead_[1]) {
      known = kAhead - 1;
      std::copy(ahead_.begin() + 1, ahead_.end(), ahead_.begin());
    } else {
      ahead_[0] = front;
      ahead_bucket_ = bucket;
    }
    for (std::size_t i = known; i < kAhead; ++i) ahead_[i] = after(ahead_[i - 1], next);
    return ahead_;
  }

 private:
  static constexpr int kDropped = 17;  // 23 bits of mantissa, 6 count
  // Costs from 2^-80 to 2^80, in squared mean edges times area.
  static constexpr std::int64_t kLowest = std::int64_t{127 - 80} << (23 - kDropped);
  static constexpr std::size_t kBuckets = std::size_t{160} << (23 - kDropped);

  // The first that is not empty, from k on; kBuckets: none.
  std::size_t filledFrom(std::size_t k) const {
    std::size_t word = k / 64;
    if (word >= filled_.size()) return kBuckets;
    std::uint64_t bits = filled_[word] >> (k % 64) << (k % 64);
    while (bits == 0) {
      if (++word == filled_.size()) return kBuckets;
      bits = filled_[word];
    }
    return word * 64 + static_cast<std::size_t>(std::countr_zero(bits));
  }

  // Finds the vertex that follows one of ahead_bucket_.
  template <typename Next>
  std::uint32_t after(std::uint32_t vertex, const Next& next) {
    const std::uint32_t follows = vertex == kNone ? kNone : next(vertex);
    if (follows != kNone || ahead_bucket_ == kBuckets) return follows;
    ahead_bucket_ = filledFrom(ahead_bucket_ + 1);
    return ahead_bucket_ == kBuckets ? kNone : first_[ahead_bucket_];
  }

  std::vector<std::uint32_t> first_;
  std::vector<std::uint64_t> filled_;
  std::size_t current_ = kBuckets - 1;
  std::array<std::uint32_t, kAhead> ahead_ = {kNone, kNone, kNone, kNone, kNone};
  std::size_t ahead_bucket_ = kBuckets;  // the last one's
};

}  // namespace merlin::render
