// PostureSink: recognises the posture in each glove sample and publishes it; passes all samples on
// to the next sink. Runs on the glove's thread.
#pragma once

#include <memory>
#include <optional>

#include "daemon/base/handover.h"
#include "daemon/shm/layout.h"
#include "drivers/port/sample_sink.h"
#include "nn/drift.h"
#include "nn/hold.h"

namespace merlin::devices {

// Takes no lock and allocates nothing, except in the constructor and reload(). The posture is
// published before its glove sample, so that a reader that waits for the sample finds the posture.
class PostureSink final : public SampleSink {
 public:
  struct Settings {
    nn::HoldSettings hold;
    nn::DriftSettings drift;
  };
  // `shown`: receives the posture of each sample. `held`: receives the current posture, which was
  // held for the minimum time.
  struct Outputs {
    shm::Channel<PostureSample>& shown;
    shm::SeqSlot<PostureState>& held;
  };
  // If there are no `postures`, no posture is recognised or published.
  PostureSink(const std::optional<nn::TrainedPostures>& postures, const Settings& settings,
              Outputs outputs, SampleSink& next)
      : recognition_(made(postures, settings)),  // NOLINT(*NewDeleteLeaks): the member owns it
        outputs_(outputs),
        next_(next) {}

  // Uses these postures and settings from the next sample on. The current posture ends and is
  // recognised anew; the sensor drift that was tracked so far is lost. May be called by one other
  // thread.
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
  std::uint32_t entered_ = 0;         // number of postures that have begun since the start
  std::uint32_t entered_before_ = 0;  // the part of entered_ from before the last reload()
};

}  // namespace merlin::devices
