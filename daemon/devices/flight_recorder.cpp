#include "daemon/devices/flight_recorder.h"

#include <algorithm>
#include <ctime>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "daemon/base/dated_files.h"
#include "daemon/base/files.h"
#include "daemon/shm/device_slots.h"
#include "daemon/shm/segment.h"
#include "drivers/port/health_reasons.h"

namespace merlin::devices {
namespace {

constexpr std::size_t kMostDumps = 8;  // maximum number of files kept for each device

}  // namespace

Result<Ok> FlightRecorder::keepForNextRun(std::size_t devices) {
  const std::string name = shm::segmentName(instance_, "flight");
  LeftFlight left = LeftFlight::under(name);
  auto store = FlightStore::make(name, devices);
  const std::lock_guard lock(mutex_);
  left_ = std::move(left);
  if (!store) return store.error();
  store_ = *std::move(store);
  return Ok{};
}

FlightRing& FlightRecorder::ringOf(std::size_t device, std::string name, std::string driver,
                                   int baud) {
  const std::lock_guard lock(mutex_);
  auto entry = std::ranges::find(entries_, device, &Entry::place);
  if (entry == entries_.end()) {
    auto ring = store_ ? std::make_unique<FlightRing>(store_->memory(device))
                       : std::make_unique<FlightRing>();
    entry = entries_.insert(entry, {device, {}, std::move(ring), false, 0, {}});
  }
  entry->device = {std::move(name), std::move(driver), baud};
  if (store_) store_->describe(device, entry->device);
  return *entry->ring;
}

void FlightRecorder::expectEnd(std::size_t device) {
  const std::lock_guard lock(mutex_);
  const auto entry = std::ranges::find(entries_, device, &Entry::place);
  if (entry != entries_.end()) entry->was_well = false;
}

std::vector<Event> FlightRecorder::check() {
  const std::lock_guard lock(mutex_);
  std::vector<Event> events;
  writeLeft(events);
  for (Entry& entry : entries_) {
    const auto health = segment_.health[entry.place].read();
    if (!health) continue;
    const bool well = health->state == HealthState::kOk;
    const bool fell = entry.was_well && !well && std::string_view(health->reason) != kStopped;
    entry.was_well = well;
    if (well) entry.well_ns = health->since_ns;
    if (!fell) continue;
    const bool brief = health->since_ns - entry.well_ns < shm::kBriefly.count();
    if (std::exchange(entry.fell, health->reason) == health->reason && brief) continue;
    const auto file = write(entry, health->reason);
    events.push_back(
        file ? newsEvent(fmt::format("the last bytes of {} are in {}", entry.device.name, *file))
             : faultEvent(file.error().what));
  }
  return events;
}

// Writes the bytes that a crashed process left. REQUIRES: mutex_ is held.
void FlightRecorder::writeLeft(std::vector<Event>& events) {
  const LeftFlight left = std::exchange(left_, {});
  const std::vector<FlightDevice> devices = left.devices();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (devices[i].name.empty()) continue;
    const auto file = write({devices[i], left.memory(i), ""}, "merlind crashed or was killed");
    events.push_back(file ? newsEvent(fmt::format("merlind crashed or was killed; the last bytes "
                                                  "of {} before that are in {}",
                                                  devices[i].name, *file))
                          : faultEvent(file.error().what));
  }
}

Result<std::vector<std::string>> FlightRecorder::dump() {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> files;
  for (const Entry& entry : entries_) {
    auto file = write(entry, "on command");
    if (!file) return file.error();
    files.push_back(*std::move(file));
  }
  return files;
}

Result<std::string> FlightRecorder::write(const Entry& entry, std::string_view why) const {
  const auto health = segment_.health[entry.place].read().value_or(DeviceHealth{});
  return write(Dump{entry.device, entry.ring->memory(), health.identity}, why);
}

Result<std::string> FlightRecorder::write(const Dump& dump, std::string_view why) const {
  const DatedFiles files(folder_, fmt::format("{}-{}", instance_, dump.device.name), ".bytes",
                         kMostDumps);
  const std::time_t now = std::time(nullptr);
  auto path = files.next(now);
  if (!path) return path.error();
  Duration left_out{};
  io::Transcript transcript;
  transcript.chunks = chunksOf(dump.memory, &left_out);
  transcript.header = {{"device", dump.identity.empty() ? "not known" : std::string(dump.identity)},
                       {"driver", dump.device.driver},
                       {"serial", fmt::format("{} 8N1", dump.device.baud)},
                       {"synthetic", "not known: recorded from the line"},
                       {"by", "merlind's flight recorder"},
                       {"date", fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::gmtime(now))},
                       {"notes", fmt::format("{}; {:.1f} s after the beginning are missing", why,
                                             toSeconds(left_out))}};
  if (const auto written = writeFile(*path, io::formatTranscript(transcript)); !written)
    return written.error();
  files.removeOldest(now);
  return path;
}

}  // namespace merlin::devices
