// Port: somebody who wants to see what an output is sent, such as `merlin snapshot --output`.
#pragma once

#include <cstddef>

#include "render/out/output.h"

namespace merlin::render::frame {

// Called on the wall's thread; never waits.
class SignalWatcher {
 public:
  virtual ~SignalWatcher() = default;

  // Whether see() is to be called with the next signal of output `i`.
  virtual bool wants(std::size_t i) const = 0;
  // Copies what it keeps.
  virtual void see(std::size_t i, const out::Signal& signal, const out::FrameInfo& info) = 0;
};

}  // namespace merlin::render::frame
