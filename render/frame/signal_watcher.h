// Port (an interface): receives signals that outputs are sent, e.g. for `merlin snapshot --output`.
#pragma once

#include <cstddef>

#include "render/out/output.h"

namespace merlin::render::frame {

// Called on the wall's thread; never waits.
class SignalWatcher {
 public:
  virtual ~SignalWatcher() = default;

  // Returns whether see() is to be called with the next signal of output `i`.
  virtual bool wants(std::size_t i) const = 0;
  // Receives the signal that output `i` was sent; its pixels are valid only during the call.
  virtual void see(std::size_t i, const out::Signal& signal, const out::FrameInfo& info) = 0;
};

}  // namespace merlin::render::frame
