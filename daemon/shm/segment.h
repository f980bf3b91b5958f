// Access to shared-memory segments, for the daemon, which writes them, and for readers in any
// process.
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

// Returns the name of a segment: "/merlin-devices" for the instance "merlin" and `what` =
// "devices". The instance distinguishes several daemons on one machine, and tests from a daemon.
std::string segmentName(const std::string& instance, const char* what);

// Addresses of a role's ZeroMQ sockets.
struct Endpoints {
  std::string status, command;
};

// Fills in a header, except the place of the table of fields. The magic number is stored last, so
// that a reader sees the complete header or none. `size`: size of the segment [bytes]. `generation`
// must differ in each run of the daemon: see newGeneration().
void fillHeader(Header& header, std::size_t size, std::uint64_t generation, Timestamp now,
                const Endpoints& endpoints);

// Returns a random 64-bit number other than 0, so that no two runs of the daemon use the same one.
std::uint64_t newGeneration();

// Checks the header of the segment `name`. Errors, whose text has the segment's name: kMalformed
// (the segment is not MERLIN's, is smaller than `least_size` bytes, or its header is damaged),
// kUnsupported (the segment has another version).
Result<Ok> checkHeader(const SharedMemory& memory, std::size_t least_size, const std::string& name);

// Owns a segment for writing. Segment is DevicesSegment or WallSegment. layout.h names the thread
// that may write each slot; writeHeartbeat() and mend() must always be called from the same thread.
template <typename Segment>
class SegmentWriter {
 public:
  // Creates the segment, with `fields` as its table of fields. Errors: those of
  // SharedMemory::create(), e.g. kBusy (a running daemon owns the segment).
  static Result<SegmentWriter> make(const std::string& name, const std::vector<Field>& fields,
                                    std::uint64_t generation, Timestamp now,
                                    const Endpoints& endpoints);

  Segment& operator*() const { return *reinterpret_cast<Segment*>(memory_.data()); }
  Segment* operator->() const { return &**this; }

  // Writes the heartbeat and realtime_offset_ns into the header. To be called ten times a second:
  // isAlive() is false one second after the last call.
  void writeHeartbeat(Timestamp now) const {
    Header& header = (*this)->header;
    header.heartbeat_ns.store(toNanoseconds(now), std::memory_order_relaxed);
    header.realtime_offset_ns.store(realtimeOffset().count(), std::memory_order_relaxed);
  }

  // Creates the segment again if another process has removed it: see SharedMemory::mend(). To be
  // called once a second from the thread that calls writeHeartbeat().
  Result<std::string> mend() { return memory_.mend(); }

 private:
  explicit SegmentWriter(SharedMemory memory) : memory_(std::move(memory)) {}
  SharedMemory memory_;
};

// Whether the daemon that writes the segment still runs, i.e. whether its last heartbeat is younger
// than a second at `now`.
bool isAlive(const Header& header, Timestamp now);

// Whether the daemon that writes the segment still runs. Unlike isAlive(), this is also true if its
// heartbeat is late because the machine is too busy, as long as a process of the same user holds
// the lock of the segment `name`. Cost: microseconds if the heartbeat is late.
bool isRunning(const std::string& name, const Header& header, Timestamp now);

// Maps a segment read-only and accesses it as the C++ struct Segment. For the devices' segment,
// programs should use DevicesReader instead.
template <typename Segment>
class SegmentReader {
 public:
  using View = Segment;

  // Opens the segment `name`. `from`: whose segments are accepted. Errors: those of
  // SharedMemory::open(), e.g. kNotFound (no daemon has created it), and of checkHeader().
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

// Maps the devices' segment read-only and finds its slots by name. The segment may therefore have
// other devices than this program knows, and slots at other offsets than in this release.
class DevicesReader {
 public:
  using View = DeviceSlots;

  // Opens the segment `name`. `from`: whose segments are accepted. Errors: those of
  // SegmentReader::open(), SlotTable::read() and DeviceSlots::find(), e.g. kUnsupported if the
  // segment lacks a slot.
  static Result<DevicesReader> open(const std::string& name,
                                    SharedMemory::From from = SharedMemory::From::kAnyone);

  const DeviceSlots& operator*() const { return slots_; }
  const DeviceSlots* operator->() const { return &slots_; }
  // Returns the table of all slots, to find those that DeviceSlots does not contain.
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

// A reader for a daemon that may run longer than the owner of the segment: it opens the segment as
// soon as the segment exists, and opens it again after its owner was restarted. If a segment cannot
// be read, it logs a warning, once until the reason changes. Reader is DevicesReader or
// SegmentReader<WallSegment>. `from`: whose segments it accepts. Thread-bound.
template <typename Reader>
class SegmentFollower {
 public:
  explicit SegmentFollower(std::string name,
                           SharedMemory::From from = SharedMemory::From::kOwnUserOrRoot)
      : name_(std::move(name)), from_(from) {}

  // Returns the content of the segment (a Reader::View), or null while no running daemon has a
  // segment that can be read. The pointer is valid until the next call. Tries to open the segment
  // at most twice a second.
  const typename Reader::View* get(Timestamp now);

 private:
  std::string name_;
  SharedMemory::From from_;
  std::optional<Reader> reader_;
  Timestamp tried_{};
  std::string logged_;  // reason of the last warning; empty: none
};

}  // namespace merlin::shm
