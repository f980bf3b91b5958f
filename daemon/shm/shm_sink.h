// ShmSink and ShmHealthSink: write the samples and the health of one device into the devices'
// segment.
#pragma once

#include "daemon/shm/layout.h"
#include "drivers/port/sample_sink.h"

namespace merlin::shm {

// Writes the samples of one device into its slots. Samples of another kind than the device's are
// dropped. Only the device's thread may call it.
class ShmSink final : public SampleSink {
 public:
  // `place`: index of the device among those of its kind, from 0. REQUIRES: the segment has slots
  // for this index.
  ShmSink(DevicesSegment& segment, SampleKind kind, std::size_t place) {
    if (kind == SampleKind::kGlove) glove_ = &segment.glove[place];
    if (kind == SampleKind::kTracker) tracker_ = &segment.tracker[place];
    if (kind == SampleKind::kBall) ball_ = &segment.ball[place];
    if (kind == SampleKind::kTouch) touch_ = &segment.touch[place];
  }

  void publish(const GloveSample& sample) noexcept override {
    if (glove_) glove_->samples.publish(sample);
  }
  void publish(const TrackerSample& sample) noexcept override {
    if (tracker_ && sample.station >= 1 && sample.station <= kStations)
      tracker_->stations[sample.station - 1].publish(sample);
  }
  void publish(const BallSample& sample) noexcept override {
    if (ball_) ball_->publish(sample);
  }
  void publish(const TouchSample& sample) noexcept override {
    if (touch_) touch_->publish(sample);
  }

 private:
  GloveSlots* glove_ = nullptr;
  TrackerSlots* tracker_ = nullptr;
  Channel<BallSample>* ball_ = nullptr;
  Channel<TouchSample>* touch_ = nullptr;
};

class ShmHealthSink final : public HealthSink {
 public:
  explicit ShmHealthSink(SeqSlot<DeviceHealth>& slot) : slot_(slot) {}
  void publish(const DeviceHealth& health) noexcept override { slot_.publish(health); }

 private:
  SeqSlot<DeviceHealth>& slot_;
};

}  // namespace merlin::shm
