// DeviceChain: the sinks that one device's samples and health pass through on their way to shared
// memory.
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

// The models that recognise postures and gestures, read from the files that the settings name;
// nothing where they name no file.
struct Trained {
  std::optional<nn::TrainedPostures> postures;
  std::optional<nn::GestureModel> gestures;
  nn::WallAxes axes;  // of the trackers
};

// Errors: those of nn::loadNetwork() and nn::loadGestures().
Result<Trained> loadTrained(const Settings& settings);

// The part of these settings that concerns the recognition of postures.
PostureSink::Settings postureSettings(const DevicesSettings& settings);

// A glove's sample first passes the recognition of postures; samples of gloves and balls begin and
// end actions. These results are written before the sample itself. A tracker's sample is written
// first and only then used for hands and gestures, so that these delay no sample. The chain is made
// once, while the device itself may be recreated. Thread-bound to the device's thread, except for
// what says otherwise.
class DeviceChain {
 public:
  // `device`: index in the list of devices. `generation`: of the daemon.
  DeviceChain(const DevicesSettings& settings, std::size_t device, const Trained& trained,
              std::uint64_t generation, shm::DevicesSegment& segment);

  // Where the driver and its loop publish.
  SampleSink& samples() { return *counts_; }
  HealthSink& health() { return *counts_; }

  // For one other thread: applies these settings from the device's next sample on.
  void rebind(const DevicesSettings& settings);
  void reloadHands(const DevicesSettings& settings);
  void reloadPostures(const Trained& trained, const DevicesSettings& settings);
  void reloadGestures(const Trained& trained, const DevicesSettings& settings);

  // To be called when the device was closed: ends the actions that its inputs hold; its counters
  // will continue from their values. REQUIRES: no thread of the device runs.
  void close(std::int64_t now_ns) noexcept;

 private:
  DeviceChain(const DevicesSettings& settings, std::size_t device, DevicePlace place,
              const Trained& trained, std::uint64_t generation, shm::DevicesSegment& segment);

  struct Hand {
    std::size_t index = 0;  // in the list of hands
    std::unique_ptr<HandGestures> gestures;
    std::unique_ptr<HandSink> sink;
  };
  SampleSink* addHand(const DevicesSettings& settings, std::size_t index, const Trained& trained,
                      std::uint64_t generation, SampleSink& next);
  HandGestures::Settings gestureSettings(const Trained& trained, const DevicesSettings& settings,
                                         std::size_t hand) const;

  shm::DevicesSegment& segment_;
  // Each sink passes samples on to the one declared before it; counts_ is the first that a sample
  // reaches.
  shm::ShmSink memory_;
  shm::ShmHealthSink health_;
  std::unique_ptr<actions::ActionSink> actions_;  // null for devices without inputs
  std::unique_ptr<PostureSink> postures_;         // null except for a glove
  std::vector<Hand> hands_;                       // that follow a tracker
  std::unique_ptr<ContinuedCounts> counts_;
};

}  // namespace merlin::devices
