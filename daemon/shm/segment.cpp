#include "daemon/shm/segment.h"

#include <algorithm>
#include <new>

#include <fmt/format.h>
#include <sys/random.h>
#include <unistd.h>

#include "daemon/base/log.h"
#include "daemon/shm/fields.h"

namespace merlin::shm {
namespace {

template <std::size_t N>
void setText(char (&field)[N], const std::string& text) {
  const std::size_t n = std::min(text.size(), N - 1);
  std::copy_n(text.begin(), n, field);
  field[n] = '\0';
}

}  // namespace

std::string segmentName(const std::string& instance, const char* what) {
  return fmt::format("/{}-{}", instance, what);
}

std::uint64_t newGeneration() {
  std::uint64_t number = 0;
  if (::getrandom(&number, sizeof number, 0) != sizeof number)
    number = static_cast<std::uint64_t>(::getpid());
  return number | 1;  // never 0
}

void fillHeader(Header& h, std::size_t size, std::uint64_t generation, Timestamp now,
                const Endpoints& endpoints) {
  h.size = size;
  h.generation = generation;
  h.heartbeat_ns.store(toNanoseconds(now), std::memory_order_relaxed);
  h.started_ns = toNanoseconds(now);
  h.realtime_offset_ns.store(realtimeOffset().count(), std::memory_order_relaxed);
  h.pid = static_cast<std::uint32_t>(::getpid());
  setText(h.status_endpoint, endpoints.status);
  setText(h.command_endpoint, endpoints.command);
  h.version = kVersion;
  std::atomic_ref(h.magic).store(
      kMagic,
      std::memory_order_release);  // stored last, so that a reader sees the complete header or none
}

Result<Ok> checkHeader(const SharedMemory& memory, std::size_t least_size,
                       const std::string& name) {
  if (memory.size() < sizeof(Header)) {
    return Error{Errc::kMalformed,
                 fmt::format("shared memory {}: is too small ({} bytes)", name, memory.size())};
  }
  const auto& h = *reinterpret_cast<const Header*>(memory.data());
  if (h.magic != kMagic) {
    return Error{Errc::kMalformed,
                 fmt::format("shared memory {}: is not a segment of MERLIN", name)};
  }
  if (h.version != kVersion) {
    return Error{Errc::kUnsupported,
                 fmt::format("shared memory {}: is version {}, but this program reads version {}; "
                             "use this program and merlind from the same release",
                             name, h.version, kVersion)};
  }
  if (memory.size() < least_size || h.size != memory.size() ||
      !TablePlace{h.field_offset, h.field_count, h.field_size}.fits(memory.size())) {
    return Error{Errc::kMalformed, fmt::format("shared memory {}: its header is damaged", name)};
  }
  return Ok{};
}

template <typename Segment>
Result<SegmentWriter<Segment>> SegmentWriter<Segment>::make(const std::string& name,
                                                            const std::vector<Field>& fields,
                                                            std::uint64_t generation, Timestamp now,
                                                            const Endpoints& endpoints) {
  auto memory = SharedMemory::create(name, sizeof(Segment));
  if (!memory) return memory.error();
  auto* segment = new (memory->data()) Segment{};
  setFields(segment->header, segment->fields, fields);
  fillHeader(segment->header, sizeof(Segment), generation, now, endpoints);
  return SegmentWriter(*std::move(memory));
}

template <typename Segment>
Result<SegmentReader<Segment>> SegmentReader<Segment>::open(const std::string& name,
                                                            SharedMemory::From from) {
  auto memory = SharedMemory::open(name, from);
  if (!memory) return memory.error();
  if (const auto checked = checkHeader(*memory, sizeof(Segment), name); !checked)
    return checked.error();
  return SegmentReader(*std::move(memory));
}

bool isAlive(const Header& header, Timestamp now) {
  constexpr Duration kGone = std::chrono::seconds(1);
  return now - fromNanoseconds(header.heartbeat_ns.load(std::memory_order_relaxed)) < kGone;
}

bool isRunning(const std::string& name, const Header& header, Timestamp now) {
  return isAlive(header, now) || SharedMemory::owned(name);
}

Result<DevicesReader> DevicesReader::open(const std::string& name, SharedMemory::From from) {
  auto memory = SharedMemory::open(name, from);
  if (!memory) return memory.error();
  if (const auto checked = checkHeader(*memory, sizeof(Header), name); !checked)
    return checked.error();
  auto table = SlotTable::read({memory->data(), memory->size()}, name);
  if (!table) return table.error();
  const auto& header = *reinterpret_cast<const Header*>(memory->data());
  auto slots = DeviceSlots::find(*table, header);
  if (!slots) return slots.error();
  return DevicesReader(*std::move(memory), *std::move(table), *std::move(slots));
}

template <typename Reader>
const typename Reader::View* SegmentFollower<Reader>::get(Timestamp now) {
  constexpr Duration kRetry = std::chrono::milliseconds(500);
  if (reader_ && reader_->alive(now)) return &**reader_;
  reader_.reset();
  if (now - tried_ < kRetry) return nullptr;
  tried_ = now;
  auto opened = Reader::open(name_, from_);
  if (!opened) {
    const bool absent = opened.error().code == Errc::kNotFound;
    if (!absent && opened.error().what != logged_) logWarning("{}", opened.error().what);
    logged_ = absent ? "" : opened.error().what;
    return nullptr;
  }
  logged_.clear();
  if (!opened->alive(now)) return nullptr;
  reader_.emplace(*std::move(opened));
  return &**reader_;
}

template class SegmentWriter<DevicesSegment>;
template class SegmentWriter<WallSegment>;
template class SegmentReader<DevicesSegment>;
template class SegmentReader<WallSegment>;
template class SegmentFollower<DevicesReader>;
template class SegmentFollower<SegmentReader<WallSegment>>;

}  // namespace merlin::shm
