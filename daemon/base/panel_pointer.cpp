#include "daemon/base/panel_pointer.h"

#include <utility>

#include <fmt/format.h>

namespace merlin {
namespace {

constexpr std::size_t kMostWaiting = 32;

}  // namespace

void PanelPointer::place(const std::optional<Place>& place) {
  if (place_ == place) return;
  leave();
  place_ = place;
}

// A motion replaces a motion that waits at the end of the queue. If the queue is full, the oldest
// entry is dropped, since the newest one describes the present state.
void PanelPointer::tell(const Told& told) {
  if (told == last_) return;
  const bool moves = told.pressed == last_.pressed && told.out == last_.out;
  last_ = told;
  if (moves && !waiting_.empty() && waiting_.back().moves)
    waiting_.back().told = told;
  else
    waiting_.push_back({told, moves});
  if (waiting_.size() > kMostWaiting) waiting_.pop_front();
}

bool PanelPointer::point(int x, int y, bool pressed) {
  const bool was = std::exchange(pressed_, pressed);
  if (!place_) return false;
  const Place& p = *place_;
  const bool inside = x >= p.x && y >= p.y && x < p.x + p.width && y < p.y + p.height;
  if (pressed && !was) held_ = inside;
  const bool released = !pressed && std::exchange(held_, false);
  const bool elsewhere = pressed && !held_;
  if (held_ || released || (inside && !elsewhere)) {
    tell({x + p.to_frame_x, y + p.to_frame_y, held_, false});
    if (released && !inside) leave();
    return true;
  }
  leave();
  return false;
}

void PanelPointer::leave() {
  held_ = false;
  if (!last_.out) tell({0, 0, false, true});
}

std::optional<std::string> PanelPointer::take(Timestamp now) {
  Told told = last_;
  if (!waiting_.empty()) {
    told = waiting_.front().told;
    waiting_.pop_front();
  } else if (!held_ || now - taken_ < kRepeat) {
    return std::nullopt;
  }
  taken_ = now;
  if (told.out) return "out";
  return fmt::format("{} {} {}", told.x, told.y, told.pressed ? 1 : 0);
}

}  // namespace merlin
