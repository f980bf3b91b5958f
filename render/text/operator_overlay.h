// OperatorOverlay: draws the wall's state over the operator's tiles.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "render/frame/overlay.h"
#include "render/text/glyph_atlas.h"
#include "render/text/operator_facts.h"
#include "render/text/operator_plate.h"
#include "render/text/plate_cover.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render::text {

// show() and isShown() are for any thread; the rest is thread-bound to the wall's thread.
class OperatorOverlay final : public frame::Overlay {
 public:
  // Draws on the plan's tiles of kind kOperator that have room for it; nothing if there are none.
  // `source` and `clock` must outlive this object. Costs about 60 ms for each size of text. Errors:
  // those of GlyphAtlas::make().
  static Result<std::unique_ptr<OperatorOverlay>> make(const tiles::TilePlan& plan,
                                                       OperatorSource& source, const Clock& clock);

  // Sets whether the overlay is drawn from the next frame on; it is initially.
  void show(bool shown) noexcept { asked_.store(shown); }
  bool isShown() const noexcept { return asked_.load(); }

  // Reads the facts at most twice a second, so that a wall that stands still is not presented more
  // often. Only if the last draw() did not read them, they are read once earlier, so that the
  // plates show the last frames of a motion.
  bool hasChanged() const override;
  // Reads the facts and redraws the plates at most ten times a second; otherwise it costs the
  // blending of the plates' pixels. erase() costs a copy of them.
  void draw(std::span<std::uint8_t> canvas) override;
  void erase(std::span<std::uint8_t> canvas) override;

 private:
  struct TilePlates {
    Rect tile;  // the tile's rectangle in the frame
    PlateFonts fonts;
    std::vector<Plate> plates;
  };

  OperatorOverlay(const tiles::TilePlan& plan, GlyphAtlas atlas, OperatorSource& source,
                  const Clock& clock);
  void refresh(Timestamp now);

  GlyphAtlas atlas_;
  PlateCover cover_;
  OperatorSource& source_;
  const Clock& clock_;
  std::vector<TilePlates> tiles_;
  OperatorFacts facts_;
  Timestamp read_at_{};            // when the facts that are drawn were read
  mutable Timestamp looked_at_{};  // when hasChanged() last read the facts
  mutable bool behind_ = false;    // draw() was called since looked_at_ and did not read the facts
  bool drawn_ = false;
  std::atomic<bool> asked_{true};
};

}  // namespace merlin::render::text
