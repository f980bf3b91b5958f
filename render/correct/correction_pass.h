// Port (an interface): evaluates the formula of correction_map.h elsewhere than on the CPU.
// Implemented by ShaderPass (render/correct/gpu).
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "render/correct/correction_map.h"

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
};

}  // namespace merlin::render::correct
