// PictureContent: shows one picture of any size at a time, as a plane or as a panorama: chooses
// tiles of its pyramid for each view, asks for those that are missing, and draws the nearest
// coarser ones until they are loaded. It can be replaced by another picture between two frames,
// without OpenGL work.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "render/content/content.h"
#include "render/content/picture/surface.h"
#include "render/content/picture/tile_cache.h"
#include "render/content/picture/tile_choice.h"
#include "render/content/picture/tile_loader.h"

namespace merlin::render::content {

// Step s has 2^-s of the texels of full detail, at which no texel is larger than a pixel of the
// wall. Costs are in units of 1024 texels and depend on the wall only, not on the picture.
class PictureDetail final : public DetailAxis {
 public:
  // `wall_px`: number of pixels of all the wall's tiles together.
  explicit PictureDetail(std::size_t wall_px) noexcept;

  std::size_t steps() const noexcept override { return kSteps; }
  std::size_t costOf(std::size_t step) const noexcept override { return full_ >> step; }
  std::size_t stepWithin(std::size_t budget) const noexcept override;
  std::size_t leastUseful() const noexcept override { return costOf(kSteps - 1); }
  std::string_view unit() const noexcept override { return "kilotexels"; }

  // Returns the largest size that a texel may have in the view at this step [px]. Since the levels
  // of a pyramid differ by a factor of 2, texels are between half this size and this size.
  static double texelSize(std::size_t step) noexcept;
  static constexpr std::size_t kSteps = 9;

 private:
  std::size_t full_;
};

struct PictureMemory {
  // Maximum size of the tiles, in memory and in textures together; 0: as much as full detail of the
  // wall takes, and at least 192 MiB, so that tiles that were seen recently are kept.
  std::size_t bytes = 0;
  std::size_t contexts = 1;  // number of OpenGL contexts that draw
};

// Returns how many tiles can be kept at once, for a wall of this many pixels.
std::size_t pictureSlots(const PictureMemory& memory, std::size_t wall_px) noexcept;

// What the renderers draw: a part of the picture, from one slot of the textures.
struct TilePiece {
  std::size_t slot = 0;
  std::uint32_t first = 0, count = 0;  // range in the index buffer
};
struct PictureVertex {
  float x = 0, y = 0, z = 0;  // content coordinates [m]
  float u = 0, v = 0;         // texture coordinates in the slot's texture, 0..1
};
struct PictureDrawList {
  std::vector<PictureVertex> vertices;
  std::vector<std::uint32_t> indices;          // 3 a triangle
  std::vector<ContentView> views;              // by tile of the wall
  std::vector<std::vector<TilePiece>> pieces;  // by tile of the wall
  std::array<float, 3> background{};
};

class PictureContent final : public Content {
 public:
  // Shows `picture` first; `tiles` must outlive this object.
  PictureContent(std::shared_ptr<const Picture> picture, TileSource& tiles, double radius_m,
                 std::size_t wall_px, const PictureMemory& memory);

  // Shows another picture from the next choose() on. To be called between frames, on the wall's
  // thread. Takes some microseconds per tile of its coarsest level.
  void show(std::shared_ptr<const Picture> picture);
  const Picture& picture() const noexcept { return *picture_; }
  void setBackground(const std::array<float, 3>& rgb) noexcept { list_.background = rgb; }

  const DetailAxis& detail() const noexcept override { return detail_; }
  ContentBounds bounds() const noexcept override;
  Navigation navigation() const noexcept override;
  void setMoving(bool moving) noexcept override { moving_ = moving; }
  void choose(std::size_t step, std::span<const ContentView> views) override;
  Pending pending() const noexcept override;
  Result<std::unique_ptr<ContentRenderer>> attach(const gl::GlApi& gl) const override;

  const TileCache& cache() const noexcept { return *cache_; }
  const PictureDrawList& drawList() const noexcept { return list_; }

 private:
  // A tile that a view needs and the cache lacks.
  struct Wanted {
    image::TilePlace place;
    double distance = 0;  // from the middle of the tile to the middle of that view, in units of
                          // half the view's size
  };
  void takeLoaded(std::size_t held);
  void chooseLeaves(double texel_px, std::span<const ContentView> views);
  bool chooseWithin(double texel_px, std::span<const ContentView> views);
  void addPieces(std::span<const ContentView> views);
  void addPiece(const image::TilePlace& leaf, std::vector<TilePiece>& pieces);
  image::TilePlace nearestThere(const image::TilePlace& leaf, std::size_t& slot);
  void addMesh(const PixelRect& rect, const image::TilePlace& source);
  void askForMissing(std::span<const ContentView> views);

  std::shared_ptr<const Picture> picture_;
  TileSource& tiles_;
  double radius_m_;
  PictureDetail detail_;
  std::unique_ptr<TileCache> cache_;  // not const: attach() lets renderers join it
  std::unique_ptr<const Surface> surface_;
  bool moving_ = false, all_there_ = false;
  std::vector<std::vector<image::TilePlace>> leaves_;  // by view
  std::vector<image::TilePlace> asked_;
  PictureDrawList list_;
};

}  // namespace merlin::render::content
