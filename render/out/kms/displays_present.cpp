// The part of Displays that takes pictures: copied, or drawn where they are shown.
#include <algorithm>
#include <cassert>
#include <utility>

#include "render/out/kms/choice.h"
#include "render/out/kms/displays.h"

namespace merlin::render::out::kms {

Result<std::optional<Timestamp>> Displays::present(std::size_t i,
                                                   std::span<const std::uint8_t> rgba,
                                                   std::uint64_t sequence) {
  using Shown = std::optional<Timestamp>;
  std::unique_lock lock(mutex_);
  if (std::exchange(sequence_, sequence) != sequence) whole_ = false;
  bool shown = false;
  if (!begun_.empty()) {
    shown = endDrawing(lock, rgba);
  } else {
    for (Screen& screen : screens_) {
      const auto write = screen.output == i ? beginWrite(screen) : std::nullopt;
      if (!write) continue;
      shown = shown || !write->replaces;
      copy(lock, *write, rgba);
    }
  }
  if (i + 1 == outputs_) {
    whole_ = true;
    if (card_) card_->wake();
  }
  if (auto why = faultOf(i); !why.empty()) return Error{Errc::kIo, std::move(why)};
  return shown ? Shown(clock_.now()) : Shown();
}

// Chooses the buffer for the screen's next picture; returns nothing if the screen takes no part in
// commits. REQUIRES: the mutex is held.
std::optional<Displays::Write> Displays::beginWrite(Screen& screen) {
  screen.wants_frame = false;
  if (!screen.lit || !screen.place) return std::nullopt;
  const BufferTurns::Write turn = screen.place->turns.beginWrite();
  return Write{screen.place, turn.buffer, turn.replaces, screen.width, screen.height};
}

// Copies a picture into the buffer that was begun; `lock`, of the mutex, is not held meanwhile.
void Displays::copy(std::unique_lock<std::mutex>& lock, const Write& write,
                    std::span<const std::uint8_t> rgba) {
  Place& place = *write.place;
  Buffer& buffer = *place.buffers[write.buffer];
  lock.unlock();
  writePicture(rgba, write.width, write.height, buffer.bytes(), buffer.pitch(), place.mode.width,
               place.mode.height);
  lock.lock();
  place.turns.endWrite(write.buffer);
}

std::vector<DrawPlace> Displays::beginDrawing(std::size_t i) {
  const std::lock_guard lock(mutex_);
  assert(begun_.empty());
  const bool copies = std::ranges::any_of(screens_, [i](const Screen& s) {
    return s.output == i && s.lit && s.place && s.place->copies;
  });
  if (copies) return {};
  std::vector<DrawPlace> places;
  for (Screen& screen : screens_) {
    const auto write = screen.output == i ? beginWrite(screen) : std::nullopt;
    if (!write) continue;
    Place& place = *write->place;
    const Mode& mode = place.mode;
    const Buffer& buffer = *place.buffers[write->buffer];
    const Corner corner = middle(write->width, write->height, mode.width, mode.height);
    places.push_back({buffer.shared(), corner.x, corner.y});
    if (!places.back().buffer) place.copy_reason = place.name + ": " + buffer.unsharedReason();
    begun_.push_back(*write);
    whole_ = false;  // the frame must not be committed without this output's picture
  }
  return places;
}

std::string Displays::copyReason(std::size_t i) const {
  const std::lock_guard lock(mutex_);
  for (const Screen& screen : screens_) {
    if (screen.output == i && screen.lit && !screen.place->copy_reason.empty())
      return screen.place->copy_reason;
  }
  return {};
}

// Ends the writes that beginDrawing() has begun, and copies the picture if it was not drawn.
// Returns whether at least one display replaces no picture that was still to be committed.
bool Displays::endDrawing(std::unique_lock<std::mutex>& lock, std::span<const std::uint8_t> rgba) {
  bool shown = false;
  for (const Write& write : std::exchange(begun_, {})) {
    shown = shown || !write.replaces;
    if (rgba.empty()) {
      write.place->was_drawn = true;
      write.place->turns.endWrite(write.buffer);
    } else {
      write.place->copies = true;
      copy(lock, write, rgba);
    }
  }
  return shown;
}

}  // namespace merlin::render::out::kms
