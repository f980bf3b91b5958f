#include "daemon/devices/flight_recorder.h"

#include <algorithm>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "daemon/base/dated_files.h"
#include "daemon/base/files.h"

namespace merlin::devices {
namespace {

constexpr std::size_t kMostDumps = 8;  // files kept per device

}  // namespace

FlightRing& FlightRecorder::ringOf(std::size_t device, std::string name, std::string driver,
                                   int baud) {
  const std::lock_guard lock(mutex_);
  auto entry = std::ranges::find(entries_, device, &Entry::device);
  if (entry == entries_.end())
    entry = entries_.insert(entry, {device, {}, {}, 0, std::make_unique<FlightRing>()});
  entry->name = std::move(name);
  entry->driver = std::move(driver);
  entry->baud = baud;
  return *entry->ring;
}

void FlightRecorder::expectEnd(std::size_t device) {
  const std::lock_guard lock(mutex_);
  const auto entry = std::ranges::find(entries_, device, &Entry::device);
  if (entry != entries_.end()) entry->was_well = false;
}

std::vector<Event> FlightRecorder::check() {
  const std::lock_guard lock(mutex_);
  std::vector<Event> events;
  for (Entry& entry : entries_) {
    const auto health = segment_.health[entry.device].read();
    if (!health) continue;
    const bool well = health->state == HealthState::kOk;
    const bool fell = entry.was_well && !well && std::string_view(health->reason) != "stopped";
    entry.was_well = well;
    if (!fell) continue;
    const auto file = write(entry, health->reason);
    events.push_back(
        file ? newsEvent(fmt::format("the last bytes of {} are in {}", entry.name, *file))
             : faultEvent(file.error().what));
  }
  return events;
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

Result<std::string> FlightRecorder::write(const Entry& entry, std::string_view why) {
  const DatedFiles files(folder_, fmt::format("{}-{}", instance_, entry.name), ".bytes",
                         kMostDumps);
  const std::time_t now = std::time(nullptr);
  auto path = files.next(now);
  if (!path) return path.error();
  Duration left_out{};
  io::Transcript transcript;
  transcript.chunks = entry.ring->take(&left_out);
  const auto health = segment_.health[entry.device].read().value_or(DeviceHealth{});
  transcript.header = {{"device", health.identity[0] ? health.identity : "not known"},
                       {"driver", entry.driver},
                       {"serial", fmt::format("{} 8N1", entry.baud)},
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
