// Port (an interface): evaluates the formula of correction_map.h elsewhere than on the CPU.
// Implemented by ShaderPass (render/correct/gpu).
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "render/correct/correction_map.h"
#include "render/frame/correction.h"

namespace merlin::render::correct {

// Thread-bound to the wall's thread.
class CorrectionPass {
 public:
  virtual ~CorrectionPass() = default;

  // Computes the whole signal, as CorrectRows does for rows. Keeps data of a map as long as
  // somebody else holds the map. Returns false if the pass is off or cannot compute this signal;
  // `signal` is undefined then, and the CPU has to compute it.
  virtual bool run(const std::shared_ptr<const CorrectionMap>& map,
                   std::span<const std::uint8_t> picture, std::span<std::uint8_t> signal) = 0;

  // Whether draw() may draw.
  virtual bool canDraw() const { return false; }
  // Draws the same signal into each of these places, of which there is at least one, and has
  // finished when it returns. `picture`: the map's source size, RGBA; `signal`: width x height x 4
  // bytes of the map; `rows`: 0 to height - 1, may repeat: those of the signal that are also
  // written to their places in `signal`, whose rest is undefined. Returns false if it cannot draw
  // there; then run() is to compute the signal. Waits for the GPU. Thread: that of run().
  virtual bool draw(const std::shared_ptr<const CorrectionMap>& /*map*/,
                    std::span<const std::uint8_t> /*picture*/,
                    std::span<const out::DrawPlace> /*places*/, std::span<const int> /*rows*/,
                    std::span<std::uint8_t> /*signal*/) {
    return false;
  }
};

}  // namespace merlin::render::correct
