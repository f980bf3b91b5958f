// PostureSink: recognises the posture of each glove sample and publishes it; passes all samples on.
// Runs on the glove's thread.
#pragma once

#include "daemon/shm/layout.h"
#include "drivers/port/sample_sink.h"
#include "nn/hold.h"
#include "nn/postures.h"

namespace merlin::devices {

// Takes no lock and allocates nothing. The posture is published before its glove sample, so that a
// reader that waits for the sample finds the posture.
class PostureSink final : public SampleSink {
 public:
  // `shown`: the posture of each record; `held`: the current posture, after the minimum hold time.
  struct Outputs {
    shm::Channel<PostureSample>& shown;
    shm::SeqSlot<PostureState>& held;
  };
  PostureSink(const nn::PostureNetwork& network, const nn::HoldSettings& hold, Outputs outputs,
              SampleSink& next)
      : unit_(network.unit), recognise_(network), hold_(hold), outputs_(outputs), next_(next) {}

  void publish(const GloveSample& sample) noexcept override;
  void publish(const TrackerSample& sample) noexcept override { next_.publish(sample); }
  void publish(const BallSample& sample) noexcept override { next_.publish(sample); }

 private:
  nn::InputUnit unit_;
  nn::Recogniser recognise_;
  nn::PostureHold hold_;
  Outputs outputs_;
  SampleSink& next_;
  std::uint32_t code_ = ~std::uint32_t{0};
  std::int64_t since_ns_ = 0;
};

}  // namespace merlin::devices
