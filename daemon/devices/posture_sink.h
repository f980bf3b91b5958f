// PostureSink: recognises the posture of each glove sample, on the glove's own thread, and hands
// both on.
#pragma once

#include "daemon/shm/layout.h"
#include "drivers/port/sample_sink.h"
#include "nn/hold.h"
#include "nn/postures.h"

namespace merlin::devices {

// Takes no lock, allocates nothing. The posture is published before its glove sample, so that
// whoever wakes for the sample finds the posture.
class PostureSink final : public SampleSink {
 public:
  // Where what one record shows goes, and what is held.
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
