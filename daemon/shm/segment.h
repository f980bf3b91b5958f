// Access to shared-memory segments: for their writer, the daemon, and for readers in any process.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/shared_memory.h"
#include "daemon/shm/device_slots.h"
#include "daemon/shm/layout.h"
#include "daemon/shm/slot_table.h"

namespace merlin::shm {

// The name of a segment, "/merlin-devices" for instance "merlin" and "devices". The instance
// distinguishes daemons on one machine, and tests from a daemon.
std::string segmentName(const std::string& instance, const char* what);

// Addresses of a role's ZeroMQ sockets.
struct Endpoints {
  std::string status, command;
};

// Fills in a header. `generation` must differ in each run of the daemon: see newGeneration().
void fillHeader(Header& header, std::size_t size, std::uint64_t generation, Timestamp now,
                const Endpoints& endpoints);

// A random 64-bit number, not 0, so that no two runs of the daemon have the same.
std::uint64_t newGeneration();

// Checks a segment's header. Errors, with the segment's name: kMalformed (not MERLIN's, too small,
// damaged), kUnsupported (another version).
Result<Ok> checkHeader(const SharedMemory& memory, std::size_t least_size, const std::string& name);

// Owns a segment for writing. Segment is DevicesSegment or WallSegment. layout.h names the thread
// that writes each slot; writeHeartbeat() must be called from one thread.
template <typename Segment>
class SegmentWriter {
 public:
  // Creates the segment. Errors: kBusy (a running daemon owns it), kIo.
  static Result<SegmentWriter> make(const std::string& name, const std::vector<Field>& fields,
                                    std::uint64_t generation, Timestamp now,
                                    const Endpoints& endpoints);

  Segment& operator*() const { return *reinterpret_cast<Segment*>(memory_.data()); }
  Segment* operator->() const { return &**this; }

  // Writes the heartbeat; to be called ten times a second.
  void writeHeartbeat(Timestamp now) const {
    Header& header = (*this)->header;
    header.heartbeat_ns.store(toNanoseconds(now), std::memory_order_relaxed);
    header.realtime_offset_ns.store(realtimeOffset().count(), std::memory_order_relaxed);
  }

  // SharedMemory::mend(); to be called once a second from writeHeartbeat()'s thread.
  Result<std::string> mend() { return memory_.mend(); }

 private:
  explicit SegmentWriter(SharedMemory memory) : memory_(std::move(memory)) {}
  SharedMemory memory_;
};

// Whether the daemon that writes the segment's heartbeat still runs.
bool isAlive(const Header& header, Timestamp now);

// The same, but also true on a machine that is too busy for a heartbeat, if a process of the same
// user holds the lock of the segment `name`. Cost: microseconds, if the heartbeat is late.
bool isRunning(const std::string& name, const Header& header, Timestamp now);

// Maps a segment read-only, and reads it by its layout. For the devices' segment use DevicesReader.
template <typename Segment>
class SegmentReader {
 public:
  using View = Segment;

  // Errors: kNotFound (no daemon has created it), kIo, kMalformed, kUnsupported.
  static Result<SegmentReader> open(const std::string& name,
                                    SharedMemory::From from = SharedMemory::From::kAnyone);

  const Segment& operator*() const { return *reinterpret_cast<const Segment*>(memory_.data()); }
  const Segment* operator->() const { return &**this; }

  // False once its daemon has ended or was restarted: open the segment again.
  bool alive(Timestamp now) const { return isAlive((*this)->header, now); }

 private:
  explicit SegmentReader(SharedMemory memory) : memory_(std::move(memory)) {}
  SharedMemory memory_;
};

// Maps the devices' segment read-only, and finds its slots by name, so the segment may have other
// devices, and at other offsets, than this release.
class DevicesReader {
 public:
  using View = DeviceSlots;

  // Errors: those of SegmentReader::open() and DeviceSlots::find(). kUnsupported also if it
  // lacks a slot.
  static Result<DevicesReader> open(const std::string& name,
                                    SharedMemory::From from = SharedMemory::From::kAnyone);

  const DeviceSlots& operator*() const { return slots_; }
  const DeviceSlots* operator->() const { return &slots_; }
  // For slots that DeviceSlots does not have.
  const SlotTable& table() const { return table_; }

  // False once its daemon has ended or was restarted: open the segment again.
  bool alive(Timestamp now) const { return isAlive(*slots_.header, now); }

 private:
  DevicesReader(SharedMemory memory, SlotTable table, DeviceSlots slots)
      : memory_(std::move(memory)), table_(std::move(table)), slots_(std::move(slots)) {}

  SharedMemory memory_;
  SlotTable table_;
  DeviceSlots slots_;
};

// A reader for a daemon, which may outlive the segment's owner: opens the segment when one exists,
// and again after its owner was restarted. Logs a warning if a segment cannot be read, once for
// each reason. Reader is DevicesReader or SegmentReader<WallSegment>. `from`: whose segments it
// accepts. Thread-bound.
template <typename Reader>
class SegmentFollower {
 public:
  explicit SegmentFollower(std::string name,
                           SharedMemory::From from = SharedMemory::From::kOwnUserOrRoot)
      : name_(std::move(name)), from_(from) {}

  // The segment's content (Reader::View), or null while no running daemon has one. Tries to open
  // the segment at most twice a second.
  const typename Reader::View* get(Timestamp now);

 private:
  std::string name_;
  SharedMemory::From from_;
  std::optional<Reader> reader_;
  Timestamp tried_{};
  std::string logged_;  // the reason that was logged last; empty: none
};

}  // namespace merlin::shm
