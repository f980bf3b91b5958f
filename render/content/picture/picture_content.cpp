#include "render/content/picture/picture_content.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "render/content/picture/picture_renderer.h"

namespace merlin::render::content {
namespace {

using image::PyramidLevel;
using image::TilePlace;

// Texels of full detail for each pixel of the wall: 1 to 4, depending on the zoom.
constexpr std::size_t kTexelsPerPixel = 2;
// Maximum number of loaded tiles that one frame takes into the cache. While the wall moves, these
// are few enough that their upload (0.1 ms each, in each context) makes no frame late; while it
// stands still, the upload is divided into slices, which bound the time.
constexpr std::size_t kTakenMoving = 6, kTakenStill = 64;
// Share of the slots that the tiles of one frame may take; the others hold coarser tiles and tiles
// that were seen recently.
constexpr double kFrameShare = 0.7;
constexpr std::size_t kMostAsked = 512;
// Memory for tiles that are in the loader, or in the cache and not uploaded by every context yet.
constexpr std::size_t kOnTheirWay = (TileLoader::kMostLoaded + kTakenStill) * image::kTileBytes;
// Interior edges of tiles overlap by this part of a texel, which the textures' borders continue
// into, so that no background shows between tiles of different levels.
constexpr double kOverlap = 0.25;

std::unique_ptr<const Surface> surfaceOf(const Picture& picture, double radius_m) {
  const PyramidLevel& finest = picture.file->levels().front();
  const auto width = static_cast<double>(finest.width), height = static_cast<double>(finest.height);
  return picture.kind == PictureKind::kPanorama ? makePanorama(width, height, radius_m)
                                                : makePlane(width, height, radius_m);
}

PictureView viewOf(const ContentView& view) {
  return {view.clip_from_metres.cast<double>(), double(view.width_px), double(view.height_px)};
}

}  // namespace

std::size_t pictureSlots(const PictureMemory& memory, std::size_t wall_px) noexcept {
  constexpr std::size_t kLeast = std::size_t{192} << 20;  // [bytes]
  // Texels are up to half as large as pixels, and tiles reach beyond the edges of the views.
  constexpr double kTilesPerPixel = 4 * 1.6 / (image::kTileSide * image::kTileSide);
  const std::size_t bytes = memory.bytes > 0 ? memory.bytes : kLeast;
  const std::size_t slots =
      TileCache::slotsWithin(bytes - std::min(bytes / 2, kOnTheirWay), memory.contexts);
  if (memory.bytes > 0) return slots;
  const double need = kTilesPerPixel * static_cast<double>(wall_px) / kFrameShare;
  const auto textures = static_cast<std::size_t>(need) / kSlotsPerTexture + 1;
  return std::max(slots, textures * kSlotsPerTexture);
}

PictureDetail::PictureDetail(std::size_t wall_px) noexcept
    : full_(std::max(kTexelsPerPixel * wall_px / 1024, std::size_t{1} << kSteps)) {}

std::size_t PictureDetail::stepWithin(std::size_t budget) const noexcept {
  std::size_t step = 0;
  while (step + 1 < kSteps && costOf(step) > budget) ++step;
  return step;
}

double PictureDetail::texelSize(std::size_t step) noexcept {
  return std::exp2(static_cast<double>(step) / 2);
}

PictureContent::PictureContent(std::shared_ptr<const Picture> picture, TileSource& tiles,
                               double radius_m, std::size_t wall_px, const PictureMemory& memory)
    : tiles_(tiles),
      radius_m_(radius_m),
      detail_(wall_px),
      cache_(std::make_unique<TileCache>(pictureSlots(memory, wall_px))) {
  show(std::move(picture));
}

void PictureContent::show(std::shared_ptr<const Picture> picture) {
  picture_ = std::move(picture);
  surface_ = surfaceOf(*picture_, radius_m_);
  cache_->show(*picture_);
  all_there_ = false;
  asked_.clear();
  tiles_.ask(picture_, {});
}

ContentBounds PictureContent::bounds() const noexcept {
  const auto radius = static_cast<float>(radius_m_);
  ContentBounds bounds{radius, Eigen::Matrix4f::Identity()};
  bounds.T_content_box.topLeftCorner<3, 3>() *= radius;
  if (picture_->kind == PictureKind::kPanorama) return bounds;
  const PyramidLevel& finest = picture_->file->levels().front();
  const Eigen::Vector3d corner = surface_->at(static_cast<double>(finest.width), 0);
  bounds.T_content_box(0, 0) = static_cast<float>(corner.x());
  bounds.T_content_box(1, 1) = static_cast<float>(corner.y());
  bounds.T_content_box(2, 2) = 0;
  return bounds;
}

Navigation PictureContent::navigation() const noexcept {
  return picture_->kind == PictureKind::kPanorama ? Navigation::kPanorama : Navigation::kPlane;
}

Pending PictureContent::pending() const noexcept {
  if (all_there_) return Pending::kNothing;
  if (tiles_.hasLoaded()) return Pending::kArrived;
  return tiles_.isLoading() ? Pending::kLoading : Pending::kNothing;
}

void PictureContent::choose(std::size_t step, std::span<const ContentView> views) {
  cache_->beginFrame();
  chooseLeaves(PictureDetail::texelSize(step), views);
  takeLoaded(cache_->freeUploaded());
  addPieces(views);
  askForMissing(views);
}

// Moves loaded tiles into the cache. Tiles that this frame needs, or the coarser ones in their
// place, are marked as used first, so that the new tiles do not replace them. `held`: tiles taken
// before that some context has not uploaded yet.
void PictureContent::takeLoaded(std::size_t held) {
  for (const auto& leaves : leaves_) {
    for (const TilePlace& leaf : leaves) {
      std::size_t slot = 0;
      nearestThere(leaf, slot);
    }
  }
  const std::size_t most = moving_ ? kTakenMoving : kTakenStill;
  for (std::size_t left = most - std::min(most, held); left > 0; --left) {
    auto tile = tiles_.take();
    if (!tile) return;
    if (tile->picture == picture_ && !tile->pixels.empty())
      cache_->put(tile->place, std::move(tile->pixels));
  }
}

// Chooses the finest tiles that fit into the cache.
void PictureContent::chooseLeaves(double texel_px, std::span<const ContentView> views) {
  constexpr int kAttempts = 24;
  for (int i = 0; i < kAttempts; ++i) {
    if (chooseWithin(texel_px * std::exp2(0.5 * i), views)) return;
  }
  // Otherwise takes all tiles of the coarsest level, which is always in the cache.
  for (auto& leaves : leaves_) {
    leaves.clear();
    const PyramidLevel& coarsest = picture_->file->levels().back();
    const int level = static_cast<int>(picture_->file->levels().size()) - 1;
    for (std::int32_t row = 0; row < coarsest.rows; ++row)
      for (std::int32_t column = 0; column < coarsest.columns; ++column)
        leaves.push_back({level, column, row});
  }
}

bool PictureContent::chooseWithin(double texel_px, std::span<const ContentView> views) {
  leaves_.resize(views.size());
  std::set<TilePlace> all;
  const auto most = static_cast<std::size_t>(kFrameShare * static_cast<double>(cache_->size()));
  for (std::size_t i = 0; i < views.size(); ++i) {
    leaves_[i].clear();
    if (!chooseTiles(picture_->file->levels(), *surface_, viewOf(views[i]), texel_px, most,
                     leaves_[i]))
      return false;
    all.insert(leaves_[i].begin(), leaves_[i].end());
  }
  return all.size() <= most;
}

// Returns the tile itself, or the nearest coarser one that is in the cache; sets `slot` to its
// slot.
TilePlace PictureContent::nearestThere(const TilePlace& leaf, std::size_t& slot) {
  const Levels levels = picture_->file->levels();
  TilePlace place = leaf;
  for (;;) {
    if (const auto found = cache_->use(place)) {
      slot = *found;
      return place;
    }
    place = parentOf(levels, place);
  }
}

void PictureContent::addPieces(std::span<const ContentView> views) {
  list_.vertices.clear();
  list_.indices.clear();
  all_there_ = true;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const std::size_t tile = views[i].tile;
    if (list_.views.size() <= tile) {
      list_.views.resize(tile + 1);
      list_.pieces.resize(tile + 1);
    }
    list_.views[tile] = views[i];
    list_.pieces[tile].clear();
    if (picture_->is_nothing) continue;
    for (const TilePlace& leaf : leaves_[i]) addPiece(leaf, list_.pieces[tile]);
    // Sorts the pieces by texture, so that PictureRenderer changes textures rarely.
    std::ranges::stable_sort(list_.pieces[tile], {},
                             [](const TilePiece& p) { return p.slot / kSlotsPerTexture; });
  }
}

void PictureContent::addPiece(const TilePlace& leaf, std::vector<TilePiece>& pieces) {
  TilePiece piece;
  const TilePlace source = nearestThere(leaf, piece.slot);
  all_there_ = all_there_ && source == leaf;
  piece.first = static_cast<std::uint32_t>(list_.indices.size());
  const Levels levels = picture_->file->levels();
  PixelRect rect = rectOf(levels, leaf);
  const double overlap = std::ldexp(kOverlap, leaf.level);
  const auto width = static_cast<double>(levels[0].width),
             height = static_cast<double>(levels[0].height);
  const bool joins = surface_->joins();
  if (rect.left > 0 || joins) rect.left -= overlap;
  if (rect.right < width || joins) rect.right += overlap;
  if (rect.top > 0) rect.top -= overlap;
  if (rect.bottom < height) rect.bottom += overlap;
  addMesh(rect, source);
  piece.count = static_cast<std::uint32_t>(list_.indices.size()) - piece.first;
  pieces.push_back(piece);
}

// Adds flat pieces of the surface, with their coordinates in the texture of `source`.
void PictureContent::addMesh(const PixelRect& rect, const TilePlace& source) {
  const int n = surface_->pieces(rect);
  const double scale = std::ldexp(1.0, -source.level);
  const auto inTexture = [&](double pixel, std::int32_t tile) {
    const double texel = pixel * scale - double{image::kTileSide} * tile;
    return static_cast<float>((texel + 1) / double{kBorderedSide});
  };
  const auto first = static_cast<std::uint32_t>(list_.vertices.size());
  for (int j = 0; j <= n; ++j) {
    const double y = j == n ? rect.bottom : rect.top + (rect.bottom - rect.top) * j / n;
    for (int i = 0; i <= n; ++i) {
      const double x = i == n ? rect.right : rect.left + (rect.right - rect.left) * i / n;
      const Eigen::Vector3f place = surface_->at(x, y).cast<float>();
      list_.vertices.push_back(
          {place.x(), place.y(), place.z(), inTexture(x, source.column), inTexture(y, source.row)});
    }
  }
  const auto row = static_cast<std::uint32_t>(n + 1);
  for (std::uint32_t j = 0; j + 1 < row; ++j) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t at = first + j * row + i;
      for (const std::uint32_t k : {at, at + 1, at + row, at + 1, at + row + 1, at + row})
        list_.indices.push_back(k);
    }
  }
}

// Asks for the missing tiles: coarse ones first, so that something sharper soon appears everywhere;
// within a level, those nearest to the middle of a view first.
void PictureContent::askForMissing(std::span<const ContentView> views) {
  const Levels levels = picture_->file->levels();
  std::vector<Wanted> wanted;
  std::set<TilePlace> seen;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const PictureView view = viewOf(views[i]);
    for (TilePlace place : leaves_[i]) {
      for (; !cache_->use(place) && seen.insert(place).second; place = parentOf(levels, place)) {
        const PixelRect r = rectOf(levels, place);
        const Eigen::Vector3d middle = surface_->at((r.left + r.right) / 2, (r.top + r.bottom) / 2);
        const Eigen::Vector4d p = view.clip_from_metres * middle.homogeneous();
        wanted.push_back({place, p.w() > 0 ? p.head<2>().norm() / p.w() : 1e9});
      }
    }
  }
  std::ranges::sort(wanted, [](const Wanted& a, const Wanted& b) {
    if (a.place.level != b.place.level) return a.place.level > b.place.level;
    return std::pair(a.distance, a.place) < std::pair(b.distance, b.place);
  });
  std::vector<TilePlace> places;
  for (const Wanted& w : wanted) {
    if (places.size() < kMostAsked) places.push_back(w.place);
  }
  if (places == asked_) return;
  asked_ = std::move(places);
  tiles_.ask(picture_, asked_);
}

Result<std::unique_ptr<ContentRenderer>> PictureContent::attach(const gl::GlApi& gl) const {
  return PictureRenderer::make(gl, list_, *cache_);
}

}  // namespace merlin::render::content
