// HandSink: makes the hand of each record of its station, on the tracker's own thread, and hands
// both on.
#pragma once

#include "daemon/shm/layout.h"
#include "drivers/hand/hand.h"
#include "drivers/port/sample_sink.h"

namespace merlin::devices {

// Takes no lock, allocates nothing: the glove's newest is read from shared memory, as any client
// reads it.
class HandSink final : public SampleSink {
 public:
  HandSink(const HandSettings& settings, shm::DevicesSegment& segment, SampleSink& next)
      : station_(static_cast<std::uint32_t>(settings.station)),
        hand_(settings),
        segment_(segment),
        next_(next) {}

  void publish(const GloveSample& sample) noexcept override { next_.publish(sample); }
  void publish(const TrackerSample& sample) noexcept override {
    next_.publish(sample);
    if (sample.station == station_)
      segment_.hand.publish(hand_.update(sample, segment_.glove.newest()));
  }
  void publish(const BallSample& sample) noexcept override { next_.publish(sample); }

 private:
  std::uint32_t station_;
  hand::Hand hand_;
  shm::DevicesSegment& segment_;
  SampleSink& next_;
};

}  // namespace merlin::devices
