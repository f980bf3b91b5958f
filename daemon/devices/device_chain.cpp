#include "daemon/devices/device_chain.h"

namespace merlin::devices {

// A glove sends about a hundred hands a second: fifteen of them are a posture that is held.
PostureSink::Settings postureSettings(const DevicesSettings& settings) {
  nn::DriftSettings drift;
  drift.least_hands = 15;
  if (!settings.posture_drift) drift.share = 0;
  return {settings.posture_hold, drift};
}

DeviceChain::DeviceChain(const DevicesSettings& settings, std::size_t device,
                         const std::optional<nn::TrainedPostures>& postures,
                         std::uint64_t generation, shm::DevicesSegment& segment)
    : DeviceChain(settings, device, devicePlaces(settings)[device], postures, generation, segment) {
}

DeviceChain::DeviceChain(const DevicesSettings& settings, std::size_t device, DevicePlace place,
                         const std::optional<nn::TrainedPostures>& postures,
                         std::uint64_t generation, shm::DevicesSegment& segment)
    : memory_(segment, place.kind, place.of_kind), health_(segment.health[device]) {
  SampleSink* next = &memory_;
  HealthSink* health = &health_;
  if (place.kind == SampleKind::kGlove || place.kind == SampleKind::kBall) {
    const shm::SeqSlot<PostureState>* state =
        place.kind == SampleKind::kGlove ? &segment.glove[place.of_kind].posture_state : nullptr;
    actions_ = std::make_unique<actions::ActionSink>(
        actions::ActionWriter(settings.bindings, {settings.list[device].name, place.kind},
                              generation, segment.actions[device]),
        actions::ActionSink::Parts{state, memory_, health_, fromSeconds(settings.stale_after_s)});
    next = actions_.get();
    health = actions_.get();
  }
  if (place.kind == SampleKind::kGlove) {
    shm::GloveSlots& slots = segment.glove[place.of_kind];
    postures_ = std::make_unique<PostureSink>(
        postures, postureSettings(settings),
        PostureSink::Outputs{slots.posture, slots.posture_state}, *next);
    next = postures_.get();
  }
  for (std::size_t i = 0; place.kind == SampleKind::kTracker && i < settings.hands.size(); ++i) {
    const HandSettings& hand = settings.hands[i];
    if (placeOf(settings, SampleKind::kTracker, hand.tracker) != place.of_kind) continue;
    const auto glove = placeOf(settings, SampleKind::kGlove, hand.glove);
    hands_.push_back(
        {i, std::make_unique<HandSink>(hand, glove ? &segment.glove[*glove].samples : nullptr,
                                       segment.hand[i], *next)});
    next = hands_.back().sink.get();
  }
  counts_ = std::make_unique<ContinuedCounts>(*next, *health);
}

void DeviceChain::rebind(const DevicesSettings& settings) {
  if (actions_) actions_->reload(settings.bindings, fromSeconds(settings.stale_after_s));
}

void DeviceChain::reloadHands(const DevicesSettings& settings) {
  for (const Hand& hand : hands_) hand.sink->reload(settings.hands[hand.index]);
}

void DeviceChain::reloadPostures(const std::optional<nn::TrainedPostures>& postures,
                                 const DevicesSettings& settings) {
  if (postures_) postures_->reload(postures, postureSettings(settings));
}

void DeviceChain::close(std::int64_t now_ns) noexcept {
  counts_->restart();
  if (actions_) actions_->release(now_ns);
}

}  // namespace merlin::devices
