#include "render/panel/panel_overlay.h"

#include <array>
#include <utility>

#include "render/text/font_file.h"

namespace merlin::render::panel {

std::optional<PanelPlace> placePanel(const tiles::TilePlan& plan, const PanelOptions& options) {
  for (const tiles::Tile& tile : plan.tiles) {
    if (tile.kind != tiles::TileKind::kOperator) continue;
    auto layout = layOutPanel(tile.width, tile.height, text::textSizeFor(tile.height), options);
    if (layout) return PanelPlace{{tile.x, tile.y, tile.width, tile.height}, *std::move(layout)};
  }
  return std::nullopt;
}

Result<std::unique_ptr<PanelOverlay>> PanelOverlay::make(const tiles::TilePlan& plan,
                                                         const PanelPlace& place,
                                                         const PanelOptions& options,
                                                         PanelSource& source) {
  const int em = text::textSizeFor(place.tile.height);
  const std::array sizes{em, smallSizeFor(em)};
  auto atlas = text::GlyphAtlas::make(text::fontFile(), sizes);
  if (!atlas) return atlas.error();
  return std::unique_ptr<PanelOverlay>(
      new PanelOverlay(plan.frame_width, place, options, *std::move(atlas), source));
}

PanelOverlay::PanelOverlay(int frame_width_px, const PanelPlace& place, const PanelOptions& options,
                           text::GlyphAtlas atlas, PanelSource& source)
    : place_(place),
      options_(options),
      atlas_(std::move(atlas)),
      source_(source),
      cover_(frame_width_px) {}

bool PanelOverlay::hasChanged() const { return !drawn_ || source_.view() != *drawn_; }

void PanelOverlay::draw(std::span<std::uint8_t> canvas) {
  const PanelView& view = source_.view();
  if (!drawn_ || view != *drawn_) {
    drawn_ = view;
    plate_ = drawPanel(view, place_.layout, options_, {{&atlas_, 0}, {&atlas_, 1}});
  }
  cover_.put(plate_, place_.tile, canvas);
}

}  // namespace merlin::render::panel
