// CorrectionPass: the port (an interface) to a processor other than the CPU that evaluates the
// formula of correction_map.h. Implemented by ShaderPass (render/correct/gpu).
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

  // Computes the whole signal, as CorrectRows does for some rows. Keeps data of a map as long as
  // somebody else holds the map. Returns false if the pass is off or cannot compute this signal;
  // `signal` is undefined then, and the CPU has to compute it.
  virtual bool run(const std::shared_ptr<const CorrectionMap>& map,
                   std::span<const std::uint8_t> picture, std::span<std::uint8_t> signal) = 0;

  // Returns whether draw() can draw into displays' memory at all.
  virtual bool canDraw() const { return false; }
  // Draws the signal that run() would compute into each of these places, at least one, and waits
  // until the GPU has finished. `picture`: RGBA, of the map's source size. `signal`: 4 x width x
  // height bytes for a map of that size. `rows`: numbers of rows, 0 to height - 1, which may
  // repeat; only these rows are also written to `signal`, whose rest is undefined. Returns false if
  // it cannot draw there; run() is then to compute the signal. Called on the thread of run().
  virtual bool draw(const std::shared_ptr<const CorrectionMap>& /*map*/,
                    std::span<const std::uint8_t> /*picture*/,
                    std::span<const out::DrawPlace> /*places*/, std::span<const int> /*rows*/,
                    std::span<std::uint8_t> /*signal*/) {
    return false;
  }
};

}  // namespace merlin::render::correct
