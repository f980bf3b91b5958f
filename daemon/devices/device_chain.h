// DeviceChain: the chain of sinks through which one device's samples and health pass on their way
// to shared memory.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "config/settings.h"
#include "daemon/actions/action_sink.h"
#include "daemon/devices/continued_counts.h"
#include "daemon/devices/device_places.h"
#include "daemon/devices/hand_gestures.h"
#include "daemon/devices/hand_sink.h"
#include "daemon/devices/posture_sink.h"
#include "daemon/shm/shm_sink.h"
#include "nn/drift.h"
#include "nn/gesture/pose.h"
#include "nn/gesture/recogniser.h"

namespace merlin::devices {

// The models that recognise postures and gestures, read from the files that the settings name. A
// model is nothing if the settings name no file for it.
struct Trained {
  std::optional<nn::TrainedPostures> postures;
  std::optional<nn::GestureModel> gestures;
  nn::WallAxes axes;  // axes of the trackers relative to the wall
};

// Reads the files of postures and gestures that the settings name. Errors: those of
// nn::loadNetwork() and nn::loadGestures().
Result<Trained> loadTrained(const Settings& settings);

// Returns the part of the settings that the recognition of postures uses.
PostureSink::Settings postureSettings(const DevicesSettings& settings);

// The posture is recognised from a glove's sample first; then samples of gloves, balls and touch
// surfaces begin and end actions. Both results are published before the sample itself. A tracker's
// sample is published first and used for hands and gestures afterwards, so that these do not delay
// it. The chain exists as long as the role; the device at its beginning may be recreated.
// Thread-bound to the device's thread, except where a comment says otherwise.
class DeviceChain {
 public:
  // `device`: index of the device in settings.list. `generation`: number of the daemon's run
  // (shm::newGeneration()). `segment` must outlive this object.
  DeviceChain(const DevicesSettings& settings, std::size_t device, const Trained& trained,
              std::uint64_t generation, shm::DevicesSegment& segment);

  // Return the first sinks of the chain, to which the driver publishes samples and its loop health.
  SampleSink& samples() { return *counts_; }
  HealthSink& health() { return *counts_; }

  // Each applies these settings from the device's next sample on. May be called by one other thread
  // while the device's thread runs.
  void rebind(const DevicesSettings& settings);
  void reloadHands(const DevicesSettings& settings);
  void reloadPostures(const Trained& trained, const DevicesSettings& settings);
  void reloadGestures(const Trained& trained, const DevicesSettings& settings);

  // Ends the actions that the device's inputs hold, and makes its counters continue from their
  // values when the device is recreated. To be called after the device was closed. REQUIRES: the
  // device's thread does not run.
  void close(std::int64_t now_ns) noexcept;

 private:
  DeviceChain(const DevicesSettings& settings, std::size_t device, DevicePlace place,
              const Trained& trained, std::uint64_t generation, shm::DevicesSegment& segment);

  struct Hand {
    std::size_t index = 0;  // index in DevicesSettings::hands
    std::unique_ptr<HandGestures> gestures;
    std::unique_ptr<HandSink> sink;
  };
  SampleSink* addHand(const DevicesSettings& settings, std::size_t index, const Trained& trained,
                      std::uint64_t generation, SampleSink& next);
  HandGestures::Settings gestureSettings(const Trained& trained, const DevicesSettings& settings,
                                         std::size_t hand) const;

  shm::DevicesSegment& segment_;
  // Each sink passes samples on to one that is declared before it; a sample reaches counts_ first.
  shm::ShmSink memory_;
  shm::ShmHealthSink health_;
  std::unique_ptr<actions::ActionSink> actions_;  // null for a tracker, which has no inputs
  std::unique_ptr<PostureSink> postures_;         // null if the device is not a glove
  std::vector<Hand> hands_;                       // the hands that follow the tracker
  std::unique_ptr<ContinuedCounts> counts_;
};

}  // namespace merlin::devices
