// Delivery: the last stages of a frame: overlays on the canvas, each output's correction, and the
// outputs.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "daemon/base/clock.h"
#include "render/frame/correction.h"
#include "render/frame/overlay.h"
#include "render/out/output_set.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render {

// Thread-bound to the wall's thread.
class Delivery {
 public:
  // All of these are borrowed. Overlays are drawn in this order. `corrections`: of each output, by
  // its number; none, or fewer, where the signal is the canvas itself, which costs nothing.
  Delivery(const TilePlan& plan, OutputSet& outputs, std::vector<Overlay*> overlays = {},
           std::vector<std::unique_ptr<Correction>> corrections = {});

  // `canvas`: RGBA of the plan's frame, which is as it was when this returns. `deadline`: when the
  // frame is due; none where nothing moves.
  void show(std::span<std::uint8_t> canvas, const FrameInfo& info,
            std::optional<Timestamp> deadline);

  // Whether the same canvas would be shown differently now.
  bool overlaysHaveChanged() const;

  const OutputSet& outputs() const noexcept { return outputs_; }

 private:
  const TilePlan& plan_;
  OutputSet& outputs_;
  std::vector<Overlay*> overlays_;
  std::vector<std::unique_ptr<Correction>> corrections_;
};

}  // namespace merlin::render
