// NoticeOverlay: shows a sentence for some time, on a plate at the lower edge of the wall's first
// tile.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "render/frame/overlay.h"
#include "render/text/glyph_atlas.h"
#include "render/text/operator_plate.h"
#include "render/text/plate_cover.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render::text {

// Draws the plate of a sentence on a tile of this size: one line, as wide as the sentence, in the
// middle of the lower edge; what is too long ends with an ellipsis. Pure. REQUIRES: the tile is at
// least kLeastTileWidth_px x kLeastTileHeight_px.
Plate drawNotice(std::string_view text, const Font& font, const Rect& tile);

// show() is thread-safe; the rest is thread-bound to the wall's thread, and never waits for a lock.
class NoticeOverlay final : public frame::Overlay {
 public:
  // If no tile of kind wall in the plan has room for the plate, nothing is drawn. `clock` must
  // outlive this object.
  NoticeOverlay(const tiles::TilePlan& plan, const Clock& clock);

  // Shows the sentence until the time `until`, in place of the one before; an empty text removes
  // it. Each call draws the plate on the calling thread; the first one also prepares the font,
  // about 60 ms. Errors: those of GlyphAtlas::make().
  Result<Ok> show(std::string_view text, Timestamp until);

  bool hasChanged() const override { return visible() != drawn_; }
  // Blends the plate's pixels onto the canvas; erase() copies the covered pixels back.
  void draw(std::span<std::uint8_t> canvas) override;
  void erase(std::span<std::uint8_t> canvas) override { cover_.erase(canvas); }

 private:
  using Shown = std::shared_ptr<const Plate>;
  Shown visible() const;

  const Clock& clock_;
  std::optional<Rect> tile_;  // the tile's rectangle in the frame; nothing: no tile has room
  PlateCover cover_;
  Shown drawn_;
  std::mutex atlas_mutex_;
  std::optional<GlyphAtlas> atlas_;  // guarded by atlas_mutex_; from the first show() on
  mutable std::mutex mutex_;
  // Guarded by mutex_.
  Shown shown_;
  Timestamp until_{};
};

}  // namespace merlin::render::text
