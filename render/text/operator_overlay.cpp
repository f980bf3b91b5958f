#include "render/text/operator_overlay.h"

#include <algorithm>
#include <ranges>
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

// `over` on `under`, as many bytes of each; `over` is premultiplied. In 16 bits, which the compiler
// makes vectors of.
void blendRow(std::span<const std::uint8_t> over, std::uint8_t* __restrict under) {
  const std::uint8_t* __restrict const from = over.data();
  for (std::size_t i = 0; i + 4 <= over.size(); i += 4) {
    const auto rest = static_cast<std::uint16_t>(255 - from[i + 3]);
    for (std::size_t c = 0; c < 4; ++c) {
      const auto x = static_cast<std::uint16_t>(under[i + c] * rest + 128);
      const auto share = static_cast<std::uint16_t>((x + (x >> 8)) >> 8);
      under[i + c] = static_cast<std::uint8_t>(from[i + c] + share);
    }
  }
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
    : atlas_(std::move(atlas)),
      frame_width_(static_cast<std::size_t>(plan.frame_width)),
      source_(source),
      clock_(clock) {
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
  if (!drawn_ || now - std::max(read_at_, looked_at_) < kLookedAt) return false;
  looked_at_ = now;
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
  covered_.clear();
  drawn_ = asked_.load();
  if (tiles_.empty() || !drawn_) return;
  const Timestamp now = clock_.now();
  if (tiles_.front().plates.empty() || now - read_at_ >= kRedrawn) refresh(now);
  for (const TilePlates& t : tiles_) {
    for (const Plate& plate : t.plates) blend(plate, t.tile, canvas);
  }
}

// Calls act(offset in the canvas, offset in the plate, bytes) for each row of a plate.
template <typename Act>
void OperatorOverlay::forEachRow(const Plate& plate, const Rect& tile, const Act& act) const {
  const std::size_t bytes = 4 * static_cast<std::size_t>(plate.at.width);
  for (int y = 0; y < plate.at.height; ++y) {
    const auto row = static_cast<std::size_t>(tile.y + plate.at.y + y);
    const auto column = static_cast<std::size_t>(tile.x + plate.at.x);
    act(4 * (row * frame_width_ + column), static_cast<std::size_t>(y) * bytes, bytes);
  }
}

void OperatorOverlay::blend(const Plate& plate, const Rect& tile, std::span<std::uint8_t> canvas) {
  forEachRow(plate, tile, [&](std::size_t at, std::size_t from, std::size_t bytes) {
    const auto under = canvas.subspan(at, bytes);
    covered_.insert(covered_.end(), under.begin(), under.end());
    blendRow(std::span(plate.rgba).subspan(from, bytes), under.data());
  });
}

// The last one first, since plates of a low tile may overlap.
void OperatorOverlay::erase(std::span<std::uint8_t> canvas) {
  std::size_t end = covered_.size();
  for (const TilePlates& t : std::views::reverse(tiles_)) {
    for (const Plate& plate : std::views::reverse(t.plates)) {
      if (end == 0) return;  // nothing was drawn
      end -= plate.rgba.size();
      forEachRow(plate, t.tile, [&](std::size_t at, std::size_t from, std::size_t bytes) {
        std::copy_n(&covered_[end + from], bytes, &canvas[at]);
      });
    }
  }
}

}  // namespace merlin::render::text
