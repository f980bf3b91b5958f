// IgnoringSink: a sink that ignores all samples. Calibrations that read a device themselves derive
// from it and override publish() for the kind of samples that they measure.
#pragma once

#include "drivers/port/sample_sink.h"

namespace merlin::cli {

class IgnoringSink : public SampleSink {
 public:
  void publish(const GloveSample&) noexcept override {}
  void publish(const TrackerSample&) noexcept override {}
  void publish(const BallSample&) noexcept override {}
  void publish(const TouchSample&) noexcept override {}
};

}  // namespace merlin::cli
