#include "daemon/devices/hand_gestures.h"

#include <algorithm>
#include <array>
#include <utility>

#include "daemon/base/commands.h"
#include "daemon/base/fixed_text.h"

namespace merlin::devices {
namespace {

constexpr std::array kHolds = {actionIndex("grab"), actionIndex("fly"), actionIndex("point_at")};

}  // namespace

HandGestures::HandGestures(const std::optional<nn::GestureModel>& model, const Settings& settings,
                           actions::ActionWriter writer, shm::SeqSlot<GestureState>& slot)
    : recognition_(made(model, settings)), writer_(std::move(writer)), slot_(slot) {
  if (recognition_) slot_.publish(state_);
}

std::unique_ptr<HandGestures::Recognition> HandGestures::made(
    const std::optional<nn::GestureModel>& model, const Settings& settings) {
  if (!model || model->gestures.empty()) return nullptr;
  return std::make_unique<Recognition>(Recognition{nn::GestureFollower(*model), settings});
}

bool HandGestures::holdsModel() const noexcept {
  return std::ranges::any_of(recognition_->settings.actions, [&](const auto* slot) {
    const auto state = slot->read();
    return state && std::ranges::any_of(kHolds, [&](std::size_t i) { return state->held[i] != 0; });
  });
}

void HandGestures::update(const HandSample& sample) noexcept {
  if (fresh_.take(recognition_) && recognition_) slot_.publish(state_);
  if (!recognition_) return;
  if (holdsModel()) recognition_->held_ns = sample.received_ns;
  const auto gesture = recognition_->follow.update(recognition_->settings.axes.turned(
      sample.received_ns, sample.position_m, sample.orientation_wxyz));
  if (gesture) publish(*gesture, sample);
}

// The follower receives every pose, even while the model is held, since it learns from ordinary
// motion how fast this person usually moves. A gesture that began before the model was last held is
// therefore discarded here.
void HandGestures::publish(const nn::Gesture& gesture, const HandSample& sample) noexcept {
  if (gesture.began_ns <= recognition_->held_ns) {
    ++state_.passed_over;
    slot_.publish(state_);
    return;
  }
  state_.received_ns = sample.received_ns;
  state_.began_ns = gesture.began_ns;
  ++state_.counter;
  state_.certainty = gesture.certainty;
  setText(state_.name, gesture.name);
  slot_.publish(state_);
  writer_.gesture(gesture.name, sample.received_ns);
}

}  // namespace merlin::devices
