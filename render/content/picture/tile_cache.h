// TileCache: keeps tiles of the picture that is shown. Each tile has a slot, which is also its
// place in the textures of every context. No OpenGL.
//
// A texture holds one texel more on each side than the tile: the border, which continues into the
// neighbours, so that filtering shows no seam between tiles. Only the edges of a tile are kept in
// memory once all contexts have its pixels.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "render/content/picture/picture.h"

namespace merlin::render::content {

// Slots whose tiles one texture (an array of layers) holds.
inline constexpr std::size_t kSlotsPerTexture = 32;
inline constexpr std::size_t kBorderedSide = image::kTileSide + 2;  // of a texture's tile [texels]

// The texels around a tile, RGBA. `top` and `bottom` have the corners.
struct TileBorder {
  std::array<std::uint8_t, 4 * kBorderedSide> top{}, bottom{};
  std::array<std::uint8_t, std::size_t{4} * image::kTileSide> left{}, right{};
};

struct TileSlot {
  std::optional<image::TilePlace> place;  // none: the slot is free
  TilePixels pixels;                      // empty once all contexts have them
  TileBorder border, edges;               // `edges`: the tile's own outermost texels
  // Increased with each change of the pixels, of the border.
  std::uint32_t version = 0, border_version = 0;
  std::uint64_t used = 0;  // frame in which it was last used
};

// The versions of pixels and borders (see TileSlot) that one context has uploaded, by slot. Written
// by the context's thread while a frame is drawn.
struct UploadedVersions {
  std::vector<std::uint32_t> pixels, borders;
};

// Thread-bound to the wall's thread, except join() and leave(); slot() may be read by the contexts'
// threads while a frame is drawn.
class TileCache {
 public:
  // REQUIRES: slots is a multiple of kSlotsPerTexture, so that it exceeds the 16 tiles that a
  // coarsest level has at most.
  explicit TileCache(std::size_t slots);

  // Returns the largest number of slots whose textures take at most `bytes` in all `contexts`
  // together, but at least kSlotsPerTexture.
  static std::size_t slotsWithin(std::size_t bytes, std::size_t contexts) noexcept;

  // Removes all tiles and puts in those of this picture's coarsest level, which are never replaced.
  void show(const Picture& picture);

  void beginFrame() noexcept { ++frame_; }
  // Returns a tile's slot and marks it as used in this frame; nothing if the cache lacks the tile.
  std::optional<std::size_t> use(const image::TilePlace& place);
  // Puts a tile in the place of the one that was used longest ago. Returns false and changes
  // nothing if all tiles are used in this frame or if the cache has the tile already.
  bool put(const image::TilePlace& place, TilePixels pixels);
  // Frees the pixels that all contexts have uploaded; returns how many slots still hold theirs.
  std::size_t freeUploaded();

  std::size_t size() const noexcept { return slots_.size(); }
  std::size_t used() const noexcept { return by_place_.size(); }
  const TileSlot& slot(std::size_t i) const noexcept { return slots_[i]; }

  // join() is called when a context begins to draw from this cache, and returns where it records
  // what it has uploaded; leave() is called when it ceases to. Thread-safe.
  UploadedVersions& join();
  void leave(const UploadedVersions& who);

 private:
  std::optional<std::size_t> freeSlot();
  void fill(std::size_t slot, const image::TilePlace& place, TilePixels pixels);
  void refreshBorders(const image::TilePlace& place);
  void refreshBorder(TileSlot& slot);
  const TileSlot* neighbour(const image::TilePlace& place, int right, int down) const;

  std::vector<TileSlot> slots_;
  std::map<image::TilePlace, std::size_t> by_place_;
  std::vector<image::PyramidLevel> levels_;
  bool joins_ = false;  // the picture's right edge joins its left one
  std::uint64_t frame_ = 1;
  std::mutex contexts_mutex_;
  std::vector<std::unique_ptr<UploadedVersions>> contexts_;
};

}  // namespace merlin::render::content
