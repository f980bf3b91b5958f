#include "drivers/touch/surface.h"

#include <algorithm>
#include <utility>

#include <linux/input-event-codes.h>
#include <linux/input.h>

namespace merlin::touch {
namespace {

constexpr std::int32_t kMostNotches = 100;  // limit of a wheel's motion in one report

constexpr std::size_t kLongestName = 200;
constexpr float kNarrowest = 0.02F, kWidest = 50;  // limits of the aspect ratio

}  // namespace

float Surface::Axis::share(std::int32_t at) const noexcept {
  return static_cast<float>((static_cast<double>(at) - low) / length());
}

void Surface::describe(const EvdevRecord& r) {
  switch (r.kind) {
    case EvdevRecord::kName:
      if (name_.size() < kLongestName) name_ += r.text.data();
      break;
    case EvdevRecord::kAxis: describeAxis(r); break;
    case EvdevRecord::kRelative:
      moves_x_ |= r.code == REL_X;
      moves_y_ |= r.code == REL_Y;
      break;
    case EvdevRecord::kKey: describeKey(r.code); break;
    default: take(r);
  }
}

void Surface::describeAxis(const EvdevRecord& r) noexcept {
  if (r.code == ABS_MT_SLOT && r.high >= 0) slot_range_ = r.high;
  if (r.low >= r.high) return;
  const Axis axis{true, r.value, r.low, r.high, r.resolution};
  switch (r.code) {
    case ABS_MT_POSITION_X: mt_x_ = axis; break;
    case ABS_MT_POSITION_Y: mt_y_ = axis; break;
    case ABS_X: x_ = axis; break;
    case ABS_Y: y_ = axis; break;
    default: break;
  }
}

void Surface::describeKey(std::uint16_t code) noexcept {
  has_touch_ |= code == BTN_TOUCH;
  has_left_ |= code == BTN_LEFT;
}

Surface::Kind Surface::choose(const TouchSettings& settings) noexcept {
  if (slot_range_ && mt_x_.there && mt_y_.there) {
    kind_ = Kind::kSlots;
    slots_used_ = std::min<std::size_t>(kSlots, static_cast<std::size_t>(*slot_range_) + 1);
  } else if (x_.there && y_.there && (has_touch_ || has_left_)) {
    kind_ = Kind::kSingle;
  } else if (moves_x_ && moves_y_ && has_left_) {
    kind_ = Kind::kMouse;
  } else {
    kind_ = Kind::kNone;
  }
  aspect_ = aspectOf(settings);
  count_y_ = 1 / static_cast<float>(settings.mouse_counts);
  // The setting applies to the surface as the person sees it, but counts are added before the axes
  // are swapped.
  count_x_ = settings.orientation.swap_axes ? count_y_ * aspect_ : count_y_ / aspect_;
  setDown(has_touch_ ? pressed_touch_ : pressed_left_);
  return kind_;
}

// Returns the aspect ratio by the settings, or by the resolutions of the axes if both have one, or
// by their ranges. Equal ranges are not evidence of a square, since many frames scale both axes to
// the same range.
float Surface::aspectOf(const TouchSettings& settings) const noexcept {
  if (settings.aspect > 0)
    return std::clamp(static_cast<float>(settings.aspect), kNarrowest, kWidest);
  if (kind_ != Kind::kSlots && kind_ != Kind::kSingle) return kUsualAspect;
  const Axis& x = kind_ == Kind::kSlots ? mt_x_ : x_;
  const Axis& y = kind_ == Kind::kSlots ? mt_y_ : y_;
  double ratio = x.length() / y.length();
  if (x.resolution > 0 && y.resolution > 0)
    ratio *= static_cast<double>(y.resolution) / x.resolution;
  else if (x.length() == y.length())
    return kUsualAspect;
  if (settings.orientation.swap_axes) ratio = 1 / ratio;
  return std::clamp(static_cast<float>(ratio), kNarrowest, kWidest);
}

void Surface::take(const EvdevRecord& r) noexcept {
  switch (r.kind) {
    case EvdevRecord::kMoved:
      if (r.code == ABS_X) x_.value = r.value;
      if (r.code == ABS_Y) y_.value = r.value;
      moveSlot(r);
      break;
    case EvdevRecord::kShifted: shiftMouse(r); break;
    case EvdevRecord::kPressed: press(r); break;
    default: break;
  }
}

void Surface::moveSlot(const EvdevRecord& r) noexcept {
  if (r.code == ABS_MT_SLOT) slot_ = r.value;
  if (slot_ < 0 || slot_ >= static_cast<std::int32_t>(kSlots)) return;
  Slot& slot = slots_[static_cast<std::size_t>(slot_)];
  switch (r.code) {
    case ABS_MT_POSITION_X: slot.x = r.value; break;
    case ABS_MT_POSITION_Y: slot.y = r.value; break;
    case ABS_MT_TOOL_TYPE: slot.palm = r.value == MT_TOOL_PALM; break;
    case ABS_MT_TRACKING_ID:
      // A new number is a new finger, even if the end of the former one was not reported.
      if (r.value >= 0 && r.value != slot.tracking) {
        slot.id = ++last_id_;
        slot.palm = false;
      }
      slot.tracking = r.value;
      slot.down = r.value >= 0;
      break;
    default: break;
  }
}

void Surface::shiftMouse(const EvdevRecord& r) noexcept {
  if (r.code == REL_WHEEL) {
    const std::int32_t turned = std::clamp(r.value, -kMostNotches, kMostNotches);
    notches_ = std::clamp(notches_ + turned, -kMostNotches, kMostNotches);
  }
  if (!down_) return;
  const auto shifted = [&](float from, float count) {
    return std::clamp(from + count * static_cast<float>(r.value), 0.0F, 1.0F);
  };
  if (r.code == REL_X) place_[0] = shifted(place_[0], count_x_);
  if (r.code == REL_Y) place_[1] = shifted(place_[1], count_y_);
}

void Surface::press(const EvdevRecord& r) noexcept {
  if (r.code == BTN_TOUCH) pressed_touch_ = r.value != 0;
  if (r.code == BTN_LEFT) pressed_left_ = r.value != 0;
  if (r.code > BTN_LEFT && r.code <= BTN_TASK) {
    const auto bit = static_cast<std::uint16_t>(1U << (r.code - kFirstMouseButton));
    buttons_ = static_cast<std::uint16_t>(r.value != 0 ? buttons_ | bit : buttons_ & ~bit);
  }
  if (kind_ != Kind::kNone) setDown(has_touch_ ? pressed_touch_ : pressed_left_);
}

// A drag with the mouse begins in the middle of the surface, so that it has room in every
// direction.
void Surface::setDown(bool down) noexcept {
  if (down && !down_) {
    id_ = ++last_id_;
    place_ = {0.5F, 0.5F};
  }
  down_ = down;
}

void Surface::fill(TouchFrames& frames) noexcept {
  switch (kind_) {
    case Kind::kSlots:
      for (std::size_t i = 0; i < slots_used_; ++i) {
        const Slot& slot = slots_[i];
        if (slot.down && !slot.palm) frames.add(slot.id, mt_x_.share(slot.x), mt_y_.share(slot.y));
      }
      break;
    case Kind::kSingle:
      if (down_) frames.add(id_, x_.share(x_.value), y_.share(y_.value));
      break;
    case Kind::kMouse:
      if (down_) frames.add(id_, place_[0], place_[1]);
      frames.setMouse(buttons_, std::exchange(notches_, 0));
      break;
    case Kind::kNone: break;
  }
}

}  // namespace merlin::touch
