// The part of Displays that reads back what the displays show.
#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "render/out/kms/displays.h"

namespace merlin::render::out::kms {
namespace {

constexpr int kTries = 3;

}  // namespace

Result<std::vector<Displays::Reading>> Displays::readBack(std::size_t i) {
  std::vector<Target> targets;
  std::shared_ptr<Scanout> scanout;
  {
    const std::lock_guard lock(mutex_);
    scanout = scanout_;
    for (const Screen& screen : screens_) {
      // A screen whose mode is still to be set shows what was there before.
      const bool shows = screen.output == i && screen.lit && !screen.sets_mode;
      if (shows) targets.push_back({screen.place, screen.width, screen.height});
    }
  }
  std::vector<Reading> readings;
  if (!scanout) return readings;
  for (const Target& target : targets) {
    auto reading = readOne(*scanout, target);
    if (!reading) return reading.error();
    readings.push_back(*std::move(reading));
  }
  return readings;
}

// A flip during the reading frees the buffer for the wall, which may write to it at once; the
// reading is then discarded and repeated.
Result<Displays::Reading> Displays::readOne(Scanout& scanout, const Target& target) {
  const Place& place = *target.place;
  for (int i = 0; i < kTries; ++i) {
    const auto out = scanout.look(place.crtc, place.plane);
    if (!out) return out.error();
    Reading reading{place.name, {}};
    if (!out->is_on) {
      reading.found.kind = FoundPicture::Kind::kOff;
      return reading;
    }
    const bool ours = std::ranges::any_of(
        place.buffers, [&](const auto& buffer) { return buffer->id() == out->buffer; });
    if (!ours || out->covered) {
      reading.found.kind = FoundPicture::Kind::kForeign;
      reading.programs = fmt::format("{}", fmt::join(scanout.others(), ", "));
      return reading;
    }
    const auto digest = scanout.read(out->buffer, target.width, target.height);
    if (!digest) return digest.error();
    const auto after = scanout.look(place.crtc, place.plane);
    reading.found.digest = *digest;
    if (after && *after == *out) return reading;
  }
  return Error{Errc::kBusy, fmt::format("{} shows another frame each time it is read", place.name)};
}

void Displays::showAgain(std::size_t i) {
  const std::lock_guard lock(mutex_);
  for (Screen& screen : screens_)
    if (screen.output == i) screen.again = true;
  if (card_) card_->wake();
}

// Sets the modes again of the displays for which showAgain() was called. From now on pictures are
// copied to them, since the GPU's way of drawing may have been the fault.
void Displays::lightAskedFor() {
  const std::lock_guard lock(mutex_);
  for (Screen& screen : screens_) {
    if (!std::exchange(screen.again, false) || !screen.lit) continue;
    Place& place = *screen.place;
    place.copies = true;
    if (place.was_drawn) {
      place.copy_reason =
          place.name + ": pictures are copied since the checks found another picture on it";
    }
    lightAgain(screen);
  }
}

}  // namespace merlin::render::out::kms
