// IgnoringSink: ignores the samples of a device that a calibration reads itself; each calibration
// overrides publish() for the kind of samples that it measures.
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
