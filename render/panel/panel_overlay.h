// PanelOverlay: the operator's panel, as an overlay of the wall's frames.
#pragma once

#include <memory>
#include <optional>

#include "render/frame/overlay.h"
#include "render/panel/panel_plate.h"
#include "render/text/plate_cover.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render::panel {

// The panel's place: on the first tile of kind operator that has room for it.
struct PanelPlace {
  Rect tile;  // the tile's rectangle in the frame
  PanelLayout layout;

  // Returns the panel's rectangle in the frame.
  Rect inFrame() const noexcept {
    return {tile.x + layout.at.x, tile.y + layout.at.y, layout.at.width, layout.at.height};
  }
};
// Returns the panel's place; nothing if there is no tile of kind operator with at least 320 x 240
// pixels.
std::optional<PanelPlace> placePanel(const tiles::TilePlan& plan, const PanelOptions& options);

// Port (an interface) that supplies the view of the panel that the overlay draws.
class PanelSource {
 public:
  virtual ~PanelSource() = default;

  // Called on the wall's thread, once or twice a frame; never waits.
  virtual const PanelView& view() = 0;
};

// Thread-bound to the wall's thread.
class PanelOverlay final : public frame::Overlay {
 public:
  // Makes the overlay; all arguments must outlive it. Costs about 60 ms for each of two sizes of
  // text. Errors: those of text::GlyphAtlas::make().
  static Result<std::unique_ptr<PanelOverlay>> make(const tiles::TilePlan& plan,
                                                    const PanelPlace& place,
                                                    const PanelOptions& options,
                                                    PanelSource& source);

  bool hasChanged() const override;
  // Redraws the panel if its view has changed; otherwise it costs the blending of the panel's
  // pixels. erase() costs a copy of them.
  void draw(std::span<std::uint8_t> canvas) override;
  void erase(std::span<std::uint8_t> canvas) override { cover_.erase(canvas); }

 private:
  PanelOverlay(int frame_width_px, const PanelPlace& place, const PanelOptions& options,
               text::GlyphAtlas atlas, PanelSource& source);

  const PanelPlace& place_;
  const PanelOptions& options_;
  text::GlyphAtlas atlas_;
  PanelSource& source_;
  text::PlateCover cover_;
  std::optional<PanelView> drawn_;
  text::Plate plate_;
};

}  // namespace merlin::render::panel
