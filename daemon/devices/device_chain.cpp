#include "daemon/devices/device_chain.h"

#include "drivers/io/evdev_stream.h"
#include "nn/io/gesture_file.h"
#include "nn/io/network_file.h"

namespace merlin::devices {
namespace {

// Returns the model of gestures for a hand; nothing if its gestures are switched off.
std::optional<nn::GestureModel> gesturesOf(const HandSettings& hand, const Trained& trained) {
  return hand.gestures ? trained.gestures : std::nullopt;
}

}  // namespace

Result<Trained> loadTrained(const Settings& settings) {
  Trained trained;
  if (const std::string& path = settings.devices.postures; !path.empty()) {
    const auto file = nn::loadNetwork(path);
    if (!file) return file.error();
    trained.postures = nn::trainedPostures(*file);
  }
  if (const std::string& path = settings.devices.gestures; !path.empty()) {
    auto file = nn::loadGestures(path);
    if (!file) return file.error();
    trained.gestures = std::move(file->model);
  }
  trained.axes = nn::WallAxes::of(settings.wall.scene.tracker_axes).value_or(nn::WallAxes());
  return trained;
}

// A glove sends about 100 samples a second, so fifteen samples in a row mean that a posture is
// held.
PostureSink::Settings postureSettings(const DevicesSettings& settings) {
  nn::DriftSettings drift;
  drift.least_hands = 15;
  if (!settings.posture_drift) drift.share = 0;
  return {settings.posture_hold, drift};
}

DeviceChain::DeviceChain(const DevicesSettings& settings, std::size_t device,
                         const Trained& trained, std::uint64_t generation,
                         shm::DevicesSegment& segment)
    : DeviceChain(settings, device, devicePlaces(settings)[device], trained, generation, segment) {}

DeviceChain::DeviceChain(const DevicesSettings& settings, std::size_t device, DevicePlace place,
                         const Trained& trained, std::uint64_t generation,
                         shm::DevicesSegment& segment)
    : segment_(segment),
      memory_(segment, place.kind, place.of_kind),
      health_(segment.health[device]) {
  SampleSink* next = &memory_;
  HealthSink* health = &health_;
  if (place.kind != SampleKind::kTracker) {
    const shm::SeqSlot<PostureState>* state =
        place.kind == SampleKind::kGlove ? &segment.glove[place.of_kind].posture_state : nullptr;
    actions_ = std::make_unique<actions::ActionSink>(
        actions::ActionWriter(settings.bindings,
                              {settings.list[device].name, place.kind, false, &io::keyCode},
                              generation, segment.actions[device]),
        actions::ActionSink::Parts{state, memory_, health_, fromSeconds(settings.stale_after_s)});
    next = actions_.get();
    health = actions_.get();
  }
  if (place.kind == SampleKind::kGlove) {
    shm::GloveSlots& slots = segment.glove[place.of_kind];
    postures_ = std::make_unique<PostureSink>(
        trained.postures, postureSettings(settings),
        PostureSink::Outputs{slots.posture, slots.posture_state}, *next);
    next = postures_.get();
  }
  for (std::size_t i = 0; place.kind == SampleKind::kTracker && i < settings.hands.size(); ++i) {
    if (placeOf(settings, SampleKind::kTracker, settings.hands[i].tracker) == place.of_kind)
      next = addHand(settings, i, trained, generation, *next);
  }
  counts_ = std::make_unique<ContinuedCounts>(*next, *health);
}

// Adds the sink of the hand `index`, and returns it. The sink passes the tracker's samples on to
// `next`.
SampleSink* DeviceChain::addHand(const DevicesSettings& settings, std::size_t index,
                                 const Trained& trained, std::uint64_t generation,
                                 SampleSink& next) {
  const HandSettings& hand = settings.hands[index];
  const auto glove =
      hand.wearsGlove() ? placeOf(settings, SampleKind::kGlove, hand.glove) : std::nullopt;
  Hand& added = hands_.emplace_back();
  added.index = index;
  added.gestures = std::make_unique<HandGestures>(
      gesturesOf(hand, trained), gestureSettings(trained, settings, index),
      actions::ActionWriter(settings.bindings, {hand.name, std::nullopt, true}, generation,
                            segment_.actions[shm::kFirstHandSource + index]),
      segment_.gesture[index]);
  added.sink = std::make_unique<HandSink>(hand, glove ? &segment_.glove[*glove].samples : nullptr,
                                          segment_.hand[index], *added.gestures, next);
  return added.sink.get();
}

HandGestures::Settings DeviceChain::gestureSettings(const Trained& trained,
                                                    const DevicesSettings& settings,
                                                    std::size_t hand) const {
  HandGestures::Settings gestures{trained.axes, {}};
  for (std::size_t i = 0; i < settings.list.size(); ++i) {
    if (settings.list[i].person == settings.hands[hand].person)
      gestures.actions.push_back(&segment_.actions[i]);
  }
  return gestures;
}

void DeviceChain::rebind(const DevicesSettings& settings) {
  if (actions_) actions_->reload(settings.bindings, fromSeconds(settings.stale_after_s));
  for (const Hand& hand : hands_) hand.gestures->rebind(settings.bindings);
}

void DeviceChain::reloadHands(const DevicesSettings& settings) {
  for (const Hand& hand : hands_) hand.sink->reload(settings.hands[hand.index]);
}

void DeviceChain::reloadPostures(const Trained& trained, const DevicesSettings& settings) {
  if (postures_) postures_->reload(trained.postures, postureSettings(settings));
}

void DeviceChain::reloadGestures(const Trained& trained, const DevicesSettings& settings) {
  for (const Hand& hand : hands_) {
    hand.gestures->reload(gesturesOf(settings.hands[hand.index], trained),
                          gestureSettings(trained, settings, hand.index));
  }
}

void DeviceChain::close(std::int64_t now_ns) noexcept {
  counts_->restart();
  if (actions_) actions_->release(now_ns);
}

}  // namespace merlin::devices
