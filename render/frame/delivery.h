// Delivery: the last stages of a frame: draws overlays on the canvas, applies each output's
// correction and hands the signals to the outputs.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "daemon/base/clock.h"
#include "render/frame/correction.h"
#include "render/frame/overlay.h"
#include "render/frame/signal_watcher.h"
#include "render/out/output_set.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render::frame {

// Thread-bound to the wall's thread.
class Delivery {
 public:
  // Borrows `plan`, `outputs` and the overlays, which are drawn in this order. `corrections`: one
  // per output, in the outputs' order. An output whose correction is null or missing is sent the
  // canvas itself, without a copy. A correction may draw its signal straight into the output's
  // memory (Correction::draw()); a signal that `watcher` asks for is computed in ordinary memory
  // instead. `watcher`: sees the signals that it asks for; may be null.
  Delivery(const tiles::TilePlan& plan, out::OutputSet& outputs,
           std::vector<Overlay*> overlays = {},
           std::vector<std::unique_ptr<Correction>> corrections = {},
           frame::SignalWatcher* watcher = nullptr);

  // Presents a frame to all outputs. `canvas`: RGBA of the plan's frame; overlays are erased again
  // before this returns. `deadline`: when the frame is due; nothing while no motion is shown.
  void show(std::span<std::uint8_t> canvas, const out::FrameInfo& info,
            std::optional<Timestamp> deadline);

  // Returns whether a call of show() at `now` would have an effect: an output that accepts a frame
  // then would be sent another signal (its corrected picture) than last time, an output asks for a
  // frame (Output::wantsFrame()), or `watcher` asks to see a signal.
  bool hasChanged(Timestamp now) const;

  const out::OutputSet& outputs() const noexcept { return outputs_; }

 private:
  bool isWatched(std::size_t i) const { return watcher_ && watcher_->wants(i); }
  out::Signal signalOf(std::size_t i, const out::Signal& meant, const out::FrameInfo& info,
                       bool watched);

  const tiles::TilePlan& plan_;
  out::OutputSet& outputs_;
  std::vector<Overlay*> overlays_;
  std::vector<std::unique_ptr<Correction>> corrections_;
  frame::SignalWatcher* watcher_;
};

}  // namespace merlin::render::frame
