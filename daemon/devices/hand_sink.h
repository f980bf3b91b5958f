// HandSink: combines each tracker sample of the hand's station with the newest glove sample to a
// HandSample, publishes this, and passes it to the recognition of gestures. Passes all samples on
// to the next sink first. Runs on the tracker's thread.
#pragma once

#include "daemon/base/handover.h"
#include "daemon/devices/hand_gestures.h"
#include "daemon/shm/layout.h"
#include "drivers/hand/hand.h"
#include "drivers/port/sample_sink.h"

namespace merlin::devices {

// Takes no lock and allocates nothing, except in reload(). The newest glove sample is read from
// shared memory, as other processes do.
class HandSink final : public SampleSink {
 public:
  // `glove`: samples of the glove that the hand wears; null: it wears none. `hand`: where the
  // HandSample is published. `next`: the next sink. All references must outlive this object.
  HandSink(const HandSettings& settings, const shm::Channel<GloveSample>* glove,
           shm::Channel<HandSample>& hand, HandGestures& gestures, SampleSink& next)
      : station_(static_cast<std::uint32_t>(settings.station)),
        hand_(settings),
        glove_(glove),
        slot_(hand),
        gestures_(gestures),
        next_(next) {}

  // Replaces the station and the smoothing filter from the tracker's next sample on. May be called
  // by one other thread.
  void reload(const HandSettings& settings) { fresh_.offer(settings); }

  void publish(const GloveSample& sample) noexcept override { next_.publish(sample); }
  void publish(const TrackerSample& sample) noexcept override {
    next_.publish(sample);
    if (HandSettings settings; fresh_.take(settings)) {
      station_ = static_cast<std::uint32_t>(settings.station);
      hand_ = hand::Hand(settings);
    }
    if (sample.station != station_) return;
    const HandSample hand = hand_.update(sample, glove_ ? glove_->newest() : std::nullopt);
    slot_.publish(hand);
    gestures_.update(hand);
  }
  void publish(const BallSample& sample) noexcept override { next_.publish(sample); }
  void publish(const TouchSample& sample) noexcept override { next_.publish(sample); }

 private:
  std::uint32_t station_;
  hand::Hand hand_;
  const shm::Channel<GloveSample>* glove_;
  shm::Channel<HandSample>& slot_;
  HandGestures& gestures_;
  SampleSink& next_;
  Handover<HandSettings> fresh_;
};

}  // namespace merlin::devices
