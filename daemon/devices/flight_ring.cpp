#include "daemon/devices/flight_ring.h"

#include <algorithm>
#include <cstring>

namespace merlin::devices {
namespace {

using Cell = FlightMemory::Cell;

// Bytes are added to a cell only within this time after its first byte.
constexpr std::int64_t kTogether_ns = 1'000'000;

// Adds bytes to a track: to its last cell if possible, otherwise to new ones. `last`: the writer's
// own copy of the track's last cell. `what`: time and direction of the bytes. `wraps`: whether a
// full track overwrites its oldest cells; otherwise further bytes are dropped.
template <std::size_t kSize>
void addTo(FlightMemory::Track<kSize>& track, Cell& last, const Cell& what,
           std::span<const std::byte> bytes, bool wraps) noexcept {
  while (!bytes.empty()) {
    auto n = track.count.load(std::memory_order_relaxed);
    const bool grows = last.length > 0 && last.length < sizeof last.bytes &&
                       last.to_device == what.to_device && what.ns - last.ns < kTogether_ns;
    if (!grows) {
      if (!wraps && n == kSize) return;
      last = what;
      ++n;
    }
    const std::size_t taken = std::min(bytes.size(), sizeof last.bytes - last.length);
    std::memcpy(last.bytes + last.length, bytes.data(), taken);
    last.length = static_cast<std::uint8_t>(last.length + taken);
    track.cells[(n - 1) % kSize].publish(last);
    track.count.store(n, std::memory_order_release);
    bytes = bytes.subspan(taken);
  }
}

// Returns cell i of the track. Returns nothing if it cannot be read, or if its length is invalid,
// which is possible because another process may have written the memory.
template <std::size_t kSize>
std::optional<Cell> cellOf(const FlightMemory::Track<kSize>& track, std::uint64_t i) {
  auto cell = track.cells[i % kSize].read();
  return cell && cell->length <= sizeof cell->bytes ? cell : std::nullopt;
}

}  // namespace

void FlightRing::opened(Timestamp) noexcept {
  memory_.beginning.count.store(0, std::memory_order_release);
  last_of_beginning_ = last_of_newest_ = {};
  memory_.opened_cell.store(memory_.newest.count.load(std::memory_order_relaxed),
                            std::memory_order_release);
}

void FlightRing::heard(Timestamp at, std::span<const std::byte> bytes) noexcept {
  add(at, false, bytes);
}

void FlightRing::said(Timestamp at, std::span<const std::byte> bytes) noexcept {
  add(at, true, bytes);
}

void FlightRing::add(Timestamp at, bool to_device, std::span<const std::byte> bytes) noexcept {
  const Cell what{toNanoseconds(at), static_cast<std::uint8_t>(to_device), 0, {}};
  addTo(memory_.beginning, last_of_beginning_, what, bytes, false);
  addTo(memory_.newest, last_of_newest_, what, bytes, true);
}

std::vector<io::TranscriptChunk> chunksOf(const FlightMemory& memory, Duration* left_out) {
  constexpr std::uint64_t kNewest = FlightMemory::kNewest, kBeginning = FlightMemory::kBeginning;
  *left_out = {};
  std::vector<Cell> cells;
  const std::uint64_t opened = memory.opened_cell.load(std::memory_order_acquire);
  const std::uint64_t begun =
      std::min(memory.beginning.count.load(std::memory_order_acquire), kBeginning);
  const std::uint64_t count = memory.newest.count.load(std::memory_order_acquire);
  // The oldest cell is skipped, since the writer may overwrite it now.
  const std::uint64_t oldest = count >= kNewest ? count - kNewest + 1 : 0;
  for (std::uint64_t i = 0; i < begun && oldest > opened; ++i) {
    if (const auto cell = cellOf(memory.beginning, i)) cells.push_back(*cell);
  }
  std::int64_t seen_ns = cells.empty() ? 0 : cells.back().ns, gap_ns = 0;
  for (std::uint64_t i = std::max(oldest, opened); i < count; ++i) {
    auto cell = cellOf(memory.newest, i);
    if (!cell || cell->ns <= seen_ns) continue;
    if (gap_ns == 0 && seen_ns > 0) gap_ns = cell->ns - seen_ns - kTogether_ns;
    cell->ns -= gap_ns;
    cells.push_back(*cell);
    if (gap_ns != 0) seen_ns = 0;
  }
  *left_out = Duration(gap_ns);
  std::vector<io::TranscriptChunk> chunks;
  for (const Cell& cell : cells) {
    chunks.push_back({Duration(cell.ns - cells.front().ns), cell.to_device != 0,
                      std::string(reinterpret_cast<const char*>(cell.bytes), cell.length)});
  }
  return chunks;
}

}  // namespace merlin::devices
