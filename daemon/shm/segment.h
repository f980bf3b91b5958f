// Segments: the writer's (made once, by the daemon) and the reader's (any process, any time).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/shared_memory.h"
#include "daemon/shm/layout.h"

namespace merlin::shm {

// "/merlin-devices" for instance "merlin" and "devices". An instance's name keeps two daemons on
// one machine, and tests from a daemon, apart.
std::string segmentName(const std::string& instance, const char* what);

struct Endpoints {
  std::string status, command;
};

// What the writer fills into a header. `generation` is new at each start.
void fillHeader(Header& header, std::size_t size, std::uint64_t generation, Timestamp now,
                const Endpoints& endpoints);

// A number that no other start of the daemon has used.
std::uint64_t newGeneration();

// Errors: kMalformed (not ours, too short), kUnsupported (another version); name the segment.
Result<Ok> checkHeader(const SharedMemory& memory, std::size_t least_size, const std::string& name);

// Owns a segment and writes it. Segment is DevicesSegment or WallSegment. The slots' writers are
// the threads that layout.h names; beat() is for one thread more.
template <typename Segment>
class SegmentWriter {
 public:
  // Errors: kBusy (a living daemon owns it), kIo.
  static Result<SegmentWriter> make(const std::string& name, const std::vector<Field>& fields,
                                    std::uint64_t generation, Timestamp now,
                                    const Endpoints& endpoints);

  Segment& operator*() const { return *reinterpret_cast<Segment*>(memory_.data()); }
  Segment* operator->() const { return &**this; }

  void beat(Timestamp now) const {
    Header& header = (*this)->header;
    header.heartbeat_ns.store(toNanoseconds(now), std::memory_order_relaxed);
    header.realtime_offset_ns.store(realtimeOffset().count(), std::memory_order_relaxed);
  }

  // Once a second, from beat()'s thread: SharedMemory::mend().
  Result<std::string> mend() { return memory_.mend(); }

 private:
  explicit SegmentWriter(SharedMemory memory) : memory_(std::move(memory)) {}
  SharedMemory memory_;
};

// Maps a segment read-only.
template <typename Segment>
class SegmentReader {
 public:
  // Errors: kNotFound (no daemon has made it), kMalformed, kUnsupported.
  static Result<SegmentReader> open(const std::string& name,
                                    SharedMemory::From from = SharedMemory::From::kAnyone);

  const Segment& operator*() const { return *reinterpret_cast<const Segment*>(memory_.data()); }
  const Segment* operator->() const { return &**this; }

  // False once its daemon is gone (killed, or stopped and started anew): open it again.
  bool alive(Timestamp now) const {
    constexpr Duration kGone = std::chrono::seconds(1);
    return now - fromNanoseconds((*this)->header.heartbeat_ns.load(std::memory_order_relaxed)) <
           kGone;
  }

 private:
  explicit SegmentReader(SharedMemory memory) : memory_(std::move(memory)) {}
  SharedMemory memory_;
};

// As SegmentReader, for a daemon, which outlives others: opens the segment when there is one of its
// own user or root, and again after its daemon was started anew. Thread-bound.
template <typename Segment>
class SegmentFollower {
 public:
  explicit SegmentFollower(std::string name) : name_(std::move(name)) {}

  // The segment, or null while no living daemon has one. Tries to open at most twice a second.
  const Segment* get(Timestamp now);

 private:
  std::string name_;
  std::optional<SegmentReader<Segment>> reader_;
  Timestamp tried_{};
};

}  // namespace merlin::shm
