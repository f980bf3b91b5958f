// BucketQueue: an approximately sorted priority queue of vertices; the key of a vertex is the cost
// of its cheapest edge. Private to render/reduce.
//
// Costs with equal binary exponents and equal upper six bits of the mantissa share a bucket, which
// therefore spans at most 1.6 %. Each bucket is a linked list, with one link per vertex. An entry
// never moves to another bucket: if a collapse has made its cost stale, the caller recomputes the
// cost after pop(). push(), pop() and peek() are O(1).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace merlin::render::reduce {

// `Next` is a callable, std::uint32_t& (std::uint32_t vertex), that returns the list link of a
// vertex; the caller owns the links.
class BucketQueue {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  BucketQueue() : first_(kBuckets, kNone), filled_(kBuckets / 64, 0) {}

  // Returns the lowest cost that belongs to a bucket.
  static float floorOf(std::size_t bucket) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(bucket + kLowest) << kDropped);
  }
  static std::size_t bucketOf(float cost) {
    const std::int64_t k = std::int64_t{std::bit_cast<std::uint32_t>(cost) >> kDropped} - kLowest;
    return static_cast<std::size_t>(std::clamp<std::int64_t>(k, 0, kBuckets - 1));
  }
  static constexpr std::size_t buckets() { return kBuckets; }

  // Inserts the vertex into the bucket of its cost. REQUIRES: cost > 0; the vertex is in no bucket.
  template <typename Next>
  void push(std::uint32_t vertex, float cost, const Next& next) {
    const std::size_t k = bucketOf(cost);
    next(vertex) = first_[k];
    first_[k] = vertex;
    filled_[k / 64] |= std::uint64_t{1} << (k % 64);
    current_ = std::min(current_, k);
  }

  // Removes and returns a vertex of the first non-empty bucket if the index of that bucket is below
  // `limit`; otherwise returns kNone.
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

  // Moves all vertices of `other` into this queue, in O(vertices in `other`), and leaves `other`
  // empty.
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

  // Returns the index of the bucket in which the last pop() looked, or of a lower bucket into which
  // push() has inserted a vertex since.
  std::size_t current() const noexcept { return current_; }

  static constexpr std::size_t kAhead = 5;

  // Returns the next kAhead vertices that pop() would return, filled up with kNone; use for
  // prefetching only. Vertices that push() has inserted among them since the last call may be
  // missing.
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
  static constexpr int kDropped = 17;  // number of low mantissa bits that are ignored, of 23
  // The buckets cover costs from 2^-80 to 2^80. A cost is an area times a squared distance; the
  // unit of length is the mean edge length.
  static constexpr std::int64_t kLowest = std::int64_t{127 - 80} << (23 - kDropped);
  static constexpr std::size_t kBuckets = std::size_t{160} << (23 - kDropped);

  // Returns the index of the first non-empty bucket at or after k; kBuckets if there is none.
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

  // Returns the vertex that follows `vertex` in the queue, or kNone. REQUIRES: `vertex` is in
  // bucket ahead_bucket_, which is updated to the bucket of the result.
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
