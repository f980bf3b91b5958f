#include "render/content/picture/tile_cache.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace merlin::render::content {
namespace {

using image::kTileSide;
using image::TilePlace;

constexpr std::size_t kInnerSide = kTileSide;
constexpr std::size_t kTexel = 4;
constexpr std::uint64_t kAlways = ~std::uint64_t{0};  // TileSlot::used of the coarsest level

// Returns the outermost texels of a tile, `width` columns and `height` rows of which belong to the
// picture.
TileBorder edgesOf(const TilePixels& pixels, std::size_t width, std::size_t height) {
  TileBorder edges;
  const auto texel = [&](std::size_t x, std::size_t y) {
    return &pixels[kTexel * (y * kInnerSide + x)];
  };
  std::copy_n(texel(0, 0), kTexel * kInnerSide, &edges.top[kTexel]);
  std::copy_n(texel(0, height - 1), kTexel * kInnerSide, &edges.bottom[kTexel]);
  for (std::size_t y = 0; y < kInnerSide; ++y) {
    std::copy_n(texel(0, y), kTexel, &edges.left[kTexel * y]);
    std::copy_n(texel(width - 1, y), kTexel, &edges.right[kTexel * y]);
  }
  return edges;
}

}  // namespace

TileCache::TileCache(std::size_t slots) : slots_(slots) {
  assert(slots > 0 && slots % kSlotsPerTexture == 0);
}

std::size_t TileCache::slotsWithin(std::size_t bytes, std::size_t contexts) noexcept {
  constexpr std::size_t kTexture = kTexel * kBorderedSide * kBorderedSide;
  const std::size_t each = contexts * kTexture + sizeof(TileSlot);
  const std::size_t textures = bytes / each / kSlotsPerTexture;
  return std::max<std::size_t>(textures, 1) * kSlotsPerTexture;
}

void TileCache::show(const Picture& picture) {
  for (TileSlot& slot : slots_) {
    slot.place.reset();
    slot.pixels = {};
    slot.used = 0;
  }
  by_place_.clear();
  levels_.assign(picture.file->levels().begin(), picture.file->levels().end());
  joins_ = picture.kind == PictureKind::kPanorama;
  const int level = static_cast<int>(levels_.size()) - 1;
  for (std::size_t i = 0; i < picture.coarsest.size(); ++i) {
    const auto columns = static_cast<std::size_t>(levels_.back().columns);
    const TilePlace place{level, static_cast<std::int32_t>(i % columns),
                          static_cast<std::int32_t>(i / columns)};
    fill(i, place, picture.coarsest[i]);
    slots_[i].used = kAlways;
  }
}

std::optional<std::size_t> TileCache::use(const TilePlace& place) {
  const auto found = by_place_.find(place);
  if (found == by_place_.end()) return std::nullopt;
  TileSlot& slot = slots_[found->second];
  slot.used = std::max(slot.used, frame_);
  return found->second;
}

std::optional<std::size_t> TileCache::freeSlot() {
  const auto oldest = std::ranges::min_element(slots_, {}, &TileSlot::used);
  if (oldest->used >= frame_) return std::nullopt;
  return static_cast<std::size_t>(oldest - slots_.begin());
}

bool TileCache::put(const TilePlace& place, TilePixels pixels) {
  if (by_place_.count(place) > 0) return false;
  const auto slot = freeSlot();
  if (!slot) return false;
  if (slots_[*slot].place) by_place_.erase(*slots_[*slot].place);
  fill(*slot, place, std::move(pixels));
  return true;
}

void TileCache::fill(std::size_t slot, const TilePlace& place, TilePixels pixels) {
  TileSlot& to = slots_[slot];
  const image::PyramidLevel& level = levels_[static_cast<std::size_t>(place.level)];
  const auto inside = [](std::int64_t pixels_there, std::int32_t tile) {
    return static_cast<std::size_t>(
        std::clamp<std::int64_t>(pixels_there - std::int64_t{tile} * kTileSide, 1, kTileSide));
  };
  to.edges = edgesOf(pixels, inside(level.width, place.column), inside(level.height, place.row));
  to.place = place;
  to.pixels = std::move(pixels);
  to.used = frame_;
  ++to.version;
  by_place_[place] = slot;
  refreshBorders(place);
}

const TileSlot* TileCache::neighbour(const TilePlace& place, int right, int down) const {
  const image::PyramidLevel& level = levels_[static_cast<std::size_t>(place.level)];
  std::int64_t column = place.column + right;
  if (joins_) column = (column + level.columns) % level.columns;
  const auto found =
      by_place_.find({place.level, static_cast<std::int32_t>(column), place.row + down});
  return found == by_place_.end() ? nullptr : &slots_[found->second];
}

// Refreshes the borders of a new tile and of its neighbours.
void TileCache::refreshBorders(const TilePlace& place) {
  for (int down = -1; down <= 1; ++down) {
    for (int right = -1; right <= 1; ++right) {
      const TileSlot* const slot = neighbour(place, right, down);
      if (slot) refreshBorder(slots_[static_cast<std::size_t>(slot - slots_.data())]);
    }
  }
}

// Copies the neighbours' outermost texels into the slot's border; if a neighbour is missing, the
// tile's own edge is repeated.
void TileCache::refreshBorder(TileSlot& slot) {
  const auto beside = [&](int right, int down) {
    const TileSlot* const other = neighbour(*slot.place, right, down);
    return other ? &other->edges : nullptr;
  };
  const TileBorder &own = slot.edges, *const above = beside(0, -1), *const below = beside(0, 1),
                   *const left = beside(-1, 0), *const right = beside(1, 0);
  TileBorder& b = slot.border;
  b.top = above ? above->bottom : own.top;
  b.bottom = below ? below->top : own.bottom;
  b.left = left ? left->right : own.left;
  b.right = right ? right->left : own.right;
  // Corners: those of the diagonal neighbours, or the nearest texel of the border's sides.
  const auto corner = [&](auto& row, std::size_t at, const std::uint8_t* from) {
    std::copy_n(from, kTexel, &row[at]);
  };
  constexpr std::size_t kFirst = kTexel, kLast = kTexel * kInnerSide,
                        kRight = kTexel * (kInnerSide + 1);
  constexpr std::size_t kLowest = kTexel * (kInnerSide - 1);
  const TileBorder *const above_left = beside(-1, -1), *const above_right = beside(1, -1),
                          *const below_left = beside(-1, 1), *const below_right = beside(1, 1);
  corner(b.top, 0, above_left ? &above_left->right[kLowest] : &b.top[kFirst]);
  corner(b.top, kRight, above_right ? &above_right->left[kLowest] : &b.top[kLast]);
  corner(b.bottom, 0, below_left ? &below_left->right[0] : &b.bottom[kFirst]);
  corner(b.bottom, kRight, below_right ? &below_right->left[0] : &b.bottom[kLast]);
  ++slot.border_version;
}

std::size_t TileCache::freeUploaded() {
  const std::lock_guard lock(contexts_mutex_);
  std::size_t held = 0;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i].pixels.empty() || contexts_.empty()) continue;
    const bool everywhere = std::ranges::all_of(
        contexts_, [&](const auto& context) { return context->pixels[i] == slots_[i].version; });
    if (everywhere)
      slots_[i].pixels = {};
    else
      ++held;
  }
  return held;
}

UploadedVersions& TileCache::join() {
  const std::lock_guard lock(contexts_mutex_);
  contexts_.push_back(std::make_unique<UploadedVersions>());
  contexts_.back()->pixels.resize(slots_.size());
  contexts_.back()->borders.resize(slots_.size());
  return *contexts_.back();
}

void TileCache::leave(const UploadedVersions& who) {
  const std::lock_guard lock(contexts_mutex_);
  std::erase_if(contexts_, [&](const auto& context) { return context.get() == &who; });
}

}  // namespace merlin::render::content
