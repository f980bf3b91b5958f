// HandGestures: recognises the gestures of one hand, publishes them, and begins the actions to
// which they are bound. Runs on the thread of the hand's tracker.
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

// Takes no lock and allocates nothing, except in the constructor, reload() and rebind().
//
// A motion during which the person holds one of the actions grab, fly and point_at is no gesture:
// it triggers no action, and is only counted in GestureState::passed_over.
class HandGestures {
 public:
  struct Settings {
    nn::WallAxes axes;  // axes of the tracker relative to the wall
    // Slots with the actions of the devices that belong to the same person as the hand.
    std::vector<const shm::SeqSlot<shm::ActionState>*> actions;
  };
  // `writer`: begins the actions to which the hand's gestures are bound. `slot`: where gestures are
  // published; must outlive this object. If there is no model, no gesture is recognised or
  // published.
  HandGestures(const std::optional<nn::GestureModel>& model, const Settings& settings,
               actions::ActionWriter writer, shm::SeqSlot<GestureState>& slot);

  // Uses this model and these settings from the next sample on. A gesture in progress, and what was
  // learnt about the person's usual speed, are lost. May be called by one other thread.
  void reload(const std::optional<nn::GestureModel>& model, const Settings& settings) {
    fresh_.offer(made(model, settings));  // NOLINT(*NewDeleteLeaks): the handover owns it
  }
  // Replaces the bindings: see ActionWriter::rebind(). May be called by one other thread.
  void rebind(const std::vector<Binding>& bindings) { writer_.rebind(bindings); }

  // Processes the next sample of the hand. If the sample completes a gesture, publishes the gesture
  // and then begins its actions.
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
