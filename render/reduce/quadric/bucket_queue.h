// BucketQueue: a priority queue of vertices by the cost of their cheapest edge, approximately
// sorted. Private to render/reduce.
//
// A bucket holds costs with equal binary exponents and equal upper six bits of the mantissa;
// buckets are at most 1.6 % apart. Each bucket is a linked list, with one link per vertex. Entries
// never move to another bucket: a cost that a collapse has made stale is recomputed after pop().
// O(1) for each operation.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace merlin::render::reduce {

// `Next` is a callable: std::uint32_t& (std::uint32_t vertex), the vertex' link.
class BucketQueue {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  BucketQueue() : first_(kBuckets, kNone), filled_(kBuckets / 64, 0) {}

  // The lower end of the costs in a bucket.
  static float floorOf(std::size_t bucket) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(bucket + kLowest) << kDropped);
  }
  static std::size_t bucketOf(float cost) {
    const std::int64_t k = std::int64_t{std::bit_cast<std::uint32_t>(cost) >> kDropped} - kLowest;
    return static_cast<std::size_t>(std::clamp<std::int64_t>(k, 0, kBuckets - 1));
  }
  static constexpr std::size_t buckets() { return kBuckets; }

  // Inserts the vertex into the bucket of its cost. REQUIRES: cost > 0, vertex is in no bucket.
  template <typename Next>
  void push(std::uint32_t vertex, float cost, const Next& next) {
    const std::size_t k = bucketOf(cost);
    next(vertex) = first_[k];
    first_[k] = vertex;
    filled_[k / 64] |= std::uint64_t{1} << (k % 64);
    current_ = std::min(current_, k);
  }

  // Removes and returns a vertex of the first bucket that is not empty, if that bucket is before
  // `limit`; else returns kNone.
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

  // Moves all vertices of `other` into this queue; O(vertices in `other`).
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

  // The bucket in which the last pop() looked, or a lower one into which push() has inserted since.
  std::size_t current() const noexcept { return current_; }

  static constexpr std::size_t kAhead = 5;

  // The vertices that pop() would return next, then kNone; for prefetching. Vertices that push()
  // has put among them since the last call may be missing.
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
  static constexpr int kDropped = 17;  // lower bits of the mantissa that do not count: 17 of 23
  // Buckets cover costs from 2^-80 to 2^80 (area times squared distance, unit of length: mean edge
  // length).
  static constexpr std::int64_t kLowest = std::int64_t{127 - 80} << (23 - kDropped);
  static constexpr std::size_t kBuckets = std::size_t{160} << (23 - kDropped);

  // Returns the first bucket from k on that is not empty; kBuckets if there is none.
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

  // Returns the vertex after `vertex`, which is in ahead_bucket_; updates ahead_bucket_.
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
  std::size_t ahead_bucket_ = kBuckets;  // bucket of the last vertex in ahead_
};

}  // namespace merlin::render::reduce
