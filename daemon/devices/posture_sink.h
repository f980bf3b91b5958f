// PostureSink: recognises the posture of each glove sample and publishes it; passes all samples on.
// Runs on the glove's thread.
#pragma once

#include <memory>
#include <optional>

#include "daemon/base/handover.h"
#include "daemon/shm/layout.h"
#include "drivers/port/sample_sink.h"
#include "nn/drift.h"
#include "nn/hold.h"

namespace merlin::devices {

// Takes no lock and allocates nothing, except in reload(). The posture is published before its
// glove sample, so that a reader that waits for the sample finds the posture.
class PostureSink final : public SampleSink {
 public:
  struct Settings {
    nn::HoldSettings hold;
    nn::DriftSettings drift;
  };
  // `shown`: the posture of each record; `held`: the current posture, after the minimum hold time.
  struct Outputs {
    shm::Channel<PostureSample>& shown;
    shm::SeqSlot<PostureState>& held;
  };
  // Without `postures` no posture is recognised or published.
  PostureSink(const std::optional<nn::TrainedPostures>& postures, const Settings& settings,
              Outputs outputs, SampleSink& next)
      : recognition_(made(postures, settings)),  // NOLINT(*NewDeleteLeaks): the member owns it
        outputs_(outputs),
        next_(next) {}

  // For one other thread: uses these postures and settings from the next sample on. The posture
  // that is held ends and is recognised anew; the sensor drift tracked so far is forgotten.
  void reload(const std::optional<nn::TrainedPostures>& postures, const Settings& settings) {
    fresh_.offer(made(postures, settings));  // NOLINT(*NewDeleteLeaks): the handover owns it
  }

  void publish(const GloveSample& sample) noexcept override;
  void publish(const TrackerSample& sample) noexcept override { next_.publish(sample); }
  void publish(const BallSample& sample) noexcept override { next_.publish(sample); }
  void publish(const TouchSample& sample) noexcept override { next_.publish(sample); }

 private:
  struct Recognition {
    Recognition(const nn::TrainedPostures& postures, const Settings& settings)
        : recognise(postures.network, postures.statistics, settings.drift),
          hold(settings.hold),
          unit(postures.network.unit) {}
    nn::DriftFollower recognise;
    std::int64_t received_ns = 0;  // of the last sample
    std::uint32_t flags = 0;       // of the last sample
    std::int64_t since_ns = 0;
    nn::PostureHold hold;
    std::uint32_t code = ~std::uint32_t{0};
    nn::InputUnit unit;
  };
  static std::unique_ptr<Recognition> made(const std::optional<nn::TrainedPostures>& postures,
                                           const Settings& settings) {
    return postures ? std::make_unique<Recognition>(*postures, settings) : nullptr;
  }
  void recognise(const GloveSample& sample) noexcept;
  void endPosture(const GloveSample& sample) noexcept;

  std::unique_ptr<Recognition> recognition_;  // null: no posture is recognised
  Outputs outputs_;
  SampleSink& next_;
  Handover<std::unique_ptr<Recognition>> fresh_;
  std::uint32_t entered_ = 0;         // number of postures that have begun so far
  std::uint32_t entered_before_ = 0;  // those of earlier recognitions
};

}  // namespace merlin::devices
