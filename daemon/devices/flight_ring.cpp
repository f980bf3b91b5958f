#include "daemon/devices/flight_ring.h"

#include <algorithm>
#include <cstring>

namespace merlin::devices {
namespace {

constexpr std::int64_t kTogether_ns = 1'000'000;  // bytes that arrive within this time share a cell

}  // namespace

FlightRing::FlightRing() {
  beginning_.cells = std::vector<shm::SeqSlot<Cell>>(kBeginning);
  newest_.cells = std::vector<shm::SeqSlot<Cell>>(kNewest);
}

void FlightRing::opened(Timestamp) noexcept {
  beginning_.count.store(0, std::memory_order_release);
  beginning_.last = {};
  newest_.last = {};
  opened_cell_.store(newest_.count.load(std::memory_order_relaxed), std::memory_order_release);
}

void FlightRing::heard(Timestamp at, std::span<const std::byte> bytes) noexcept {
  add(at, false, bytes);
}

void FlightRing::said(Timestamp at, std::span<const std::byte> bytes) noexcept {
  add(at, true, bytes);
}

void FlightRing::add(Timestamp at, bool to_device, std::span<const std::byte> bytes) noexcept {
  beginning_.add(toNanoseconds(at), to_device, bytes, false);
  newest_.add(toNanoseconds(at), to_device, bytes, true);
}

void FlightRing::Track::add(std::int64_t ns, bool to_device, std::span<const std::byte> bytes,
                            bool wraps) noexcept {
  while (!bytes.empty()) {
    auto n = count.load(std::memory_order_relaxed);
    const bool grows = last.length > 0 && last.length < sizeof last.bytes &&
                       last.to_device == (to_device ? 1 : 0) && ns - last.ns < kTogether_ns;
    if (!grows) {
      if (!wraps && n == cells.size()) return;
      last = {ns, static_cast<std::uint8_t>(to_device), 0, {}};
      ++n;
    }
    const std::size_t taken = std::min(bytes.size(), sizeof last.bytes - last.length);
    std::memcpy(last.bytes + last.length, bytes.data(), taken);
    last.length = static_cast<std::uint8_t>(last.length + taken);
    cells[(n - 1) % cells.size()].publish(last);
    count.store(n, std::memory_order_release);
    bytes = bytes.subspan(taken);
  }
}

std::vector<io::TranscriptChunk> FlightRing::take(Duration* left_out) const {
  *left_out = {};
  std::vector<Cell> cells;
  const std::uint64_t opened = opened_cell_.load(std::memory_order_acquire);
  const std::uint64_t begun = beginning_.count.load(std::memory_order_acquire);
  const std::uint64_t count = newest_.count.load(std::memory_order_acquire);
  // The oldest cell is skipped: it may be overwritten while we read.
  const std::uint64_t oldest = count >= kNewest ? count - kNewest + 1 : 0;
  for (std::uint64_t i = 0; i < begun && oldest > opened; ++i) {
    if (const auto cell = beginning_.cells[i].read()) cells.push_back(*cell);
  }
  std::int64_t seen_ns = cells.empty() ? 0 : cells.back().ns, gap_ns = 0;
  for (std::uint64_t i = std::max(oldest, opened); i < count; ++i) {
    auto cell = newest_.cells[i % kNewest].read();
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
