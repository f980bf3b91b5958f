#include "render/frame/pointer_marker.h"

#include <algorithm>
#include <cmath>

namespace merlin::render::frame {
namespace {

// Sizes with which a disc is visible from across a hall, on a bright model and on a dark
// background.
constexpr int kRadius_px = 9, kRim_px = 3;
constexpr std::uint8_t kDiscs[PointerMarker::kMost][3] = {
    {255, 120, 0}, {0, 150, 255}, {60, 200, 60}, {200, 80, 255}};
constexpr std::uint8_t kRim[3] = {20, 20, 20};

// Returns the point's pixel, counted from the tile's upper left corner; it may lie beyond the
// tile's edges.
std::optional<Eigen::Vector2i> pixelIn(const tiles::Tile& tile, const Eigen::Vector3f& at_eye_m) {
  const Eigen::Vector4f clip = tile.projection * tile.view * at_eye_m.homogeneous();
  if (clip.w() <= 0) return std::nullopt;  // behind the eye
  const Eigen::Vector2f ndc = clip.head<2>() / clip.w();
  if (ndc.cwiseAbs().maxCoeff() > 2) return std::nullopt;
  return Eigen::Vector2i(
      static_cast<int>(std::floor((ndc.x() + 1) / 2 * static_cast<float>(tile.width))),
      static_cast<int>(std::floor((1 - ndc.y()) / 2 * static_cast<float>(tile.height))));
}

bool within(const tiles::Tile& tile, const Eigen::Vector2i& p) {
  return p.x() >= 0 && p.y() >= 0 && p.x() < tile.width && p.y() < tile.height;
}

}  // namespace

PointerMarker::PointerMarker(const tiles::TilePlan& plan) : plan_(plan) {
  constexpr std::size_t kSide = 2 * kRadius_px + 1;
  covered_.reserve(kMost * plan.tiles.size() * kSide * kSide);
}

std::optional<Eigen::Vector2i> PointerMarker::pixelOf(const Eigen::Vector3f& at_eye_m) const {
  for (const tiles::Tile& tile : plan_.tiles) {
    if (!tile.followsWall()) continue;
    const auto p = pixelIn(tile, at_eye_m);
    if (p && within(tile, *p)) return Eigen::Vector2i(tile.x, tile.y) + *p;
  }
  return std::nullopt;
}

void PointerMarker::draw(std::span<std::uint8_t> canvas) {
  drawn_ = pixels();
  for (std::size_t i = kMost; i-- > 0;) {  // the hand that acts on the wall last, on top
    if (!drawn_[i]) continue;
    for (const tiles::Tile& tile : plan_.tiles) {
      if (!tile.isFitted()) drawIn(tile, *at_eye_m_[i], kDiscs[i], canvas);
    }
  }
}

void PointerMarker::drawIn(const tiles::Tile& tile, const Eigen::Vector3f& at_eye_m,
                           const std::uint8_t* colour, std::span<std::uint8_t> pixels) {
  const auto middle = pixelIn(tile, at_eye_m);
  if (!middle) return;
  for (int y = -kRadius_px; y <= kRadius_px; ++y) {
    for (int x = -kRadius_px; x <= kRadius_px; ++x) {
      const Eigen::Vector2i p = *middle + Eigen::Vector2i(x, y);
      const int from_middle = x * x + y * y;
      if (from_middle > kRadius_px * kRadius_px || !within(tile, p)) continue;
      const auto row = static_cast<std::size_t>(tile.y + p.y());
      const std::size_t at = 4 * (row * static_cast<std::size_t>(plan_.frame_width) +
                                  static_cast<std::size_t>(tile.x + p.x()));
      covered_.push_back({at, {pixels[at], pixels[at + 1], pixels[at + 2]}});
      constexpr int kInner = (kRadius_px - kRim_px) * (kRadius_px - kRim_px);
      std::copy_n(from_middle <= kInner ? colour : kRim, 3, &pixels[at]);
    }
  }
}

void PointerMarker::erase(std::span<std::uint8_t> canvas) {
  // In reverse order: where discs overlap, only the first one drawn has saved the picture's pixels.
  for (auto c = covered_.rbegin(); c != covered_.rend(); ++c)
    std::copy_n(c->rgb, 3, &canvas[c->at]);
  covered_.clear();
}

PointerMarker::Pixels PointerMarker::pixels() const {
  Pixels pixels;
  for (std::size_t i = 0; i < kMost; ++i) {
    if (at_eye_m_[i]) pixels[i] = pixelOf(*at_eye_m_[i]);
  }
  return pixels;
}

bool PointerMarker::hasChanged() const { return pixels() != drawn_; }

}  // namespace merlin::render::frame
