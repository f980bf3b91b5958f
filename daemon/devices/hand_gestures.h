// HandGestures: recognises the gestures of one hand, publishes them, and begins the actions that
// they are bound to. Runs on the thread of the hand's tracker.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "daemon/actions/action_writer.h"
#include "daemon/base/handover.h"
#include "daemon/shm/layout.h"
#include "nn/gesture/follower.h"
#include "nn/gesture/pose.h"

namespace merlin::devices {

// Takes no lock and allocates nothing, except in reload() and rebind().
//
// A motion during which the person holds the model, by grab, fly or point_at, is no gesture: it is
// counted in GestureState::passed_over, and does nothing.
class HandGestures {
 public:
  struct Settings {
    nn::WallAxes axes;  // of the tracker
    // The actions of the devices that belong to the hand's person.
    std::vector<const shm::SeqSlot<shm::ActionState>*> actions;
  };
  // `writer`: for the actions that the hand's gestures are bound to. Without a model no gesture is
  // recognised or published.
  HandGestures(const std::optional<nn::GestureModel>& model, const Settings& settings,
               actions::ActionWriter writer, shm::SeqSlot<GestureState>& slot);

  // For one other thread: uses this model and these settings from the next sample on. A gesture in
  // progress and the pace that was learnt are forgotten.
  void reload(const std::optional<nn::GestureModel>& model, const Settings& settings) {
    fresh_.offer(made(model, settings));  // NOLINT(*NewDeleteLeaks): the handover owns it
  }
  // For one other thread: see ActionWriter::rebind().
  void rebind(const std::vector<Binding>& bindings) { writer_.rebind(bindings); }

  // Takes the next sample of the hand. If the sample completes a gesture, the gesture is published
  // and then its action begun, before this returns.
  void update(const HandSample& sample) noexcept;

 private:
  struct Recognition {
    nn::GestureFollower follow;
    Settings settings;
    std::int64_t held_ns = INT64_MIN;  // time of the last sample at which the model was held
  };
  static std::unique_ptr<Recognition> made(const std::optional<nn::GestureModel>& model,
                                           const Settings& settings);
  bool holdsModel() const noexcept;
  void publish(const nn::Gesture& gesture, const HandSample& sample) noexcept;

  std::unique_ptr<Recognition> recognition_;  // null: no gesture is recognised
  Handover<std::unique_ptr<Recognition>> fresh_;
  actions::ActionWriter writer_;
  GestureState state_{};
  shm::SeqSlot<GestureState>& slot_;
};

}  // namespace merlin::devices
