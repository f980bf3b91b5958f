#include "render/text/operator_overlay.h"

#include <algorithm>
#include <utility>

#include "render/text/font_file.h"

namespace merlin::render::text {
namespace {

constexpr Duration kRedrawn = std::chrono::milliseconds(100);
constexpr Duration kLookedAt = std::chrono::milliseconds(500);

bool hasPlates(const tiles::Tile& tile) {
  return tile.kind == tiles::TileKind::kOperator && tile.width >= kLeastTileWidth_px &&
         tile.height >= kLeastTileHeight_px;
}

std::vector<int> sizesFor(const tiles::TilePlan& plan) {
  std::vector<int> sizes;
  for (const tiles::Tile& tile : plan.tiles) {
    if (!hasPlates(tile)) continue;
    sizes.push_back(textSizeFor(tile.height));
    sizes.push_back(headingSizeFor(tile.height));
  }
  return sizes;
}

}  // namespace

Result<std::unique_ptr<OperatorOverlay>> OperatorOverlay::make(const tiles::TilePlan& plan,
                                                               OperatorSource& source,
                                                               const Clock& clock) {
  auto atlas = GlyphAtlas::make(fontFile(), sizesFor(plan));
  if (!atlas) return atlas.error();
  return std::unique_ptr<OperatorOverlay>(
      new OperatorOverlay(plan, *std::move(atlas), source, clock));
}

OperatorOverlay::OperatorOverlay(const tiles::TilePlan& plan, GlyphAtlas atlas,
                                 OperatorSource& source, const Clock& clock)
    : atlas_(std::move(atlas)), cover_(plan.frame_width), source_(source), clock_(clock) {
  std::size_t size = 0;  // in the order of sizesFor()
  for (const tiles::Tile& tile : plan.tiles) {
    if (!hasPlates(tile)) continue;
    tiles_.push_back(
        {{tile.x, tile.y, tile.width, tile.height}, {{&atlas_, size}, {&atlas_, size + 1}}, {}});
    size += 2;
  }
}

bool OperatorOverlay::hasChanged() const {
  if (tiles_.empty()) return false;
  if (asked_.load() != drawn_) return true;
  const Timestamp now = clock_.now();
  const Duration period = behind_ ? kRedrawn : kLookedAt;
  if (!drawn_ || now - std::max(read_at_, looked_at_) < period) return false;
  looked_at_ = now;
  behind_ = false;
  return source_.read(now) != facts_;
}

void OperatorOverlay::refresh(Timestamp now) {
  read_at_ = now;
  OperatorFacts facts = source_.read(now);
  if (facts == facts_ && !tiles_.front().plates.empty()) return;
  facts_ = std::move(facts);
  for (TilePlates& t : tiles_)
    t.plates = drawPlates(facts_, t.fonts, {0, 0, t.tile.width, t.tile.height});
}

void OperatorOverlay::draw(std::span<std::uint8_t> canvas) {
  drawn_ = asked_.load();
  if (tiles_.empty() || !drawn_) return;
  const Timestamp now = clock_.now();
  behind_ = !tiles_.front().plates.empty() && now - read_at_ < kRedrawn;
  if (!behind_) refresh(now);
  for (const TilePlates& t : tiles_) {
    for (const Plate& plate : t.plates) cover_.put(plate, t.tile, canvas);
  }
}

void OperatorOverlay::erase(std::span<std::uint8_t> canvas) { cover_.erase(canvas); }

}  // namespace merlin::render::text
