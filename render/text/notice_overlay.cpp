#include "render/text/notice_overlay.h"

#include <algorithm>
#include <utility>

#include "render/text/font_file.h"
#include "render/text/text.h"

namespace merlin::render::text {
namespace {

constexpr Colour kNoticeGround{10, 14, 20, 215}, kNoticeText{244, 246, 248};

// Returns the rectangle of the first tile of kind wall that has room for a notice.
std::optional<Rect> noticeTile(const tiles::TilePlan& plan) {
  for (const tiles::Tile& t : plan.tiles) {
    if (t.kind == tiles::TileKind::kWall && t.width >= kLeastTileWidth_px &&
        t.height >= kLeastTileHeight_px)
      return Rect{t.x, t.y, t.width, t.height};
  }
  return std::nullopt;
}

}  // namespace

Plate drawNotice(std::string_view text, const Font& font, const Rect& tile) {
  const int em = font.metrics().em_px, padding = em * 2 / 3;
  const Rect free = shrunk(tile, em / 2);
  const int width = std::min(free.width, textWidth(font, text) + 2 * padding);
  const int height = std::min(free.height, em * 29 / 20 + 2 * (padding / 2));
  Plate plate{{free.x + (free.width - width) / 2, free.y + free.height - height, width, height},
              std::vector<std::uint8_t>(std::size_t{4} * static_cast<std::size_t>(width) *
                                        static_cast<std::size_t>(height))};
  const Surface surface(plate.rgba, width, height);
  surface.fillWhole(kNoticeGround);
  drawTextIn(surface, font, {padding, 0, width - 2 * padding, height}, text, kNoticeText);
  return plate;
}

NoticeOverlay::NoticeOverlay(const tiles::TilePlan& plan, const Clock& clock)
    : clock_(clock), tile_(noticeTile(plan)), cover_(plan.frame_width) {}

// The plate is drawn on the caller's thread, so that the wall's thread only has to blend it.
Result<Ok> NoticeOverlay::show(std::string_view text, Timestamp until) {
  if (!tile_) return Ok{};
  Shown plate;
  if (!text.empty()) {
    const std::lock_guard lock(atlas_mutex_);
    if (!atlas_) {
      const int size = headingSizeFor(tile_->height);
      auto atlas = GlyphAtlas::make(fontFile(), std::span(&size, 1));
      if (!atlas) return atlas.error();
      atlas_ = *std::move(atlas);
    }
    plate = std::make_shared<const Plate>(
        drawNotice(text, {&*atlas_, 0}, {0, 0, tile_->width, tile_->height}));
  }
  const std::lock_guard lock(mutex_);
  shown_.swap(plate);  // the old one may be freed after the lock
  until_ = until;
  return Ok{};
}

NoticeOverlay::Shown NoticeOverlay::visible() const {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return drawn_;
  return clock_.now() < until_ ? shown_ : nullptr;
}

void NoticeOverlay::draw(std::span<std::uint8_t> canvas) {
  drawn_ = visible();
  if (drawn_) cover_.put(*drawn_, *tile_, canvas);
}

}  // namespace merlin::render::text
