// PostureSink: recognises the posture of each glove sample, on the glove's own thread, and hands
// both on.
#pragma once

#include "daemon/shm/layout.h"
#include "drivers/port/sample_sink.h"
#include "nn/postures.h"

namespace merlin::devices {

// Takes no lock, allocates nothing. The posture is published before its glove sample, so that
// whoever wakes for the sample finds the posture.
class PostureSink final : public SampleSink {
 public:
  PostureSink(const nn::PostureNetwork& network, shm::Channel<PostureSample>& postures,
              SampleSink& next)
      : network_(network), postures_(postures), next_(next) {}

  void publish(const GloveSample& sample) noexcept override;
  void publish(const TrackerSample& sample) noexcept override { next_.publish(sample); }
  void publish(const BallSample& sample) noexcept override { next_.publish(sample); }

 private:
  nn::PostureNetwork network_;
  shm::Channel<PostureSample>& postures_;
  SampleSink& next_;
  std::uint32_t code_ = ~std::uint32_t{0};
  std::int64_t since_ns_ = 0;
};

}  // namespace merlin::devices
