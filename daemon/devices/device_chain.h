// DeviceChain: what one device's samples and health pass through on their way to shared memory.
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

// What recognises postures and gestures: read from the files that the settings name; nothing for
// those that name none.
struct Trained {
  std::optional<nn::TrainedPostures> postures;
  std::optional<nn::GestureModel> gestures;
  nn::WallAxes axes;  // of the trackers
};

// Errors: those of nn::loadNetwork() and nn::loadGestures().
Result<Trained> loadTrained(const Settings& settings);

// How postures are recognised with these settings.
PostureSink::Settings postureSettings(const DevicesSettings& settings);

// A glove's samples are first recognised as postures, and a glove's and a ball's begin and end
// actions; each writes its own result before the sample itself is written. A tracker's become hands
// after they were written, and then gestures, so that these delay no sample. Made once, while the
// device itself may come and go. Thread-bound to the device's thread, except for what says
// otherwise.
class DeviceChain {
 public:
  // `device`: index in the list of devices. `generation`: of the daemon.
  DeviceChain(const DevicesSettings& settings, std::size_t device, const Trained& trained,
              std::uint64_t generation, shm::DevicesSegment& segment);

  // Where the driver and its loop publish.
  SampleSink& samples() { return *counts_; }
  HealthSink& health() { return *counts_; }

  // For one other thread: these settings from the device's next sample on.
  void rebind(const DevicesSettings& settings);
  void reloadHands(const DevicesSettings& settings);
  void reloadPostures(const Trained& trained, const DevicesSettings& settings);
  void reloadGestures(const Trained& trained, const DevicesSettings& settings);

  // The device is closed: what its inputs hold ends, and its counters will go on where they are.
  // REQUIRES: no thread of the device runs.
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
  // Each passes on to the one before it; counts_ is the first that a sample reaches.
  shm::ShmSink memory_;
  shm::ShmHealthSink health_;
  std::unique_ptr<actions::ActionSink> actions_;  // null for those that have no inputs
  std::unique_ptr<PostureSink> postures_;         // null except for a glove
  std::vector<Hand> hands_;                       // that follow a tracker
  std::unique_ptr<ContinuedCounts> counts_;
};

}  // namespace merlin::devices
