// PointerMarker: the discs that show visitors where their hands point; drawn into a finished frame
// and erased again.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "render/frame/overlay.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render::frame {

// Thread-bound to the wall's thread. Allocates no memory after construction.
class PointerMarker final : public Overlay {
 public:
  // Borrows `plan`.
  explicit PointerMarker(const tiles::TilePlan& plan);

  // Returns the pixel of the frame in which a wall tile shows the point (eye coordinates, metres);
  // the pixel's centre is at x + 0.5, y + 0.5. Nothing if no wall tile shows the point.
  std::optional<Eigen::Vector2i> pixelOf(const Eigen::Vector3f& at_eye_m) const;

  // Where hands point, in eye coordinates [m]. The first point is that of the hand that acts on the
  // wall, and its disc is orange; the other discs are blue, green and violet.
  static constexpr std::size_t kMost = 4;
  using Points = std::array<std::optional<Eigen::Vector3f>, kMost>;
  // Sets the points at which discs are drawn from now on. Initially there is none.
  void pointAt(const Points& at_eye_m) { at_eye_m_ = at_eye_m; }

  bool hasChanged() const override;
  // Draws a disc around pixelOf() each point, also across seams of wall tiles, and in tiles of
  // free cameras that see the point. Cost: microseconds.
  void draw(std::span<std::uint8_t> canvas) override;
  void erase(std::span<std::uint8_t> canvas) override;

 private:
  struct Covered {
    std::size_t at;  // offset of the pixel in the canvas [bytes]
    std::uint8_t rgb[3];
  };
  using Pixels = std::array<std::optional<Eigen::Vector2i>, kMost>;
  Pixels pixels() const;
  void drawIn(const tiles::Tile& tile, const Eigen::Vector3f& at_eye_m, const std::uint8_t* colour,
              std::span<std::uint8_t> canvas);

  const tiles::TilePlan& plan_;
  Points at_eye_m_;
  Pixels drawn_;
  std::vector<Covered> covered_;
};

}  // namespace merlin::render::frame
