// PointerMarker: the disc that shows a visitor where the hand points, drawn into a finished frame
// and taken out of it again.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "render/frame/overlay.h"
#include "render/tiles/tile_plan.h"

namespace merlin::render {

// Thread-bound to the wall's thread. Allocates nothing once it is made.
class PointerMarker final : public Overlay {
 public:
  // Borrowed.
  explicit PointerMarker(const TilePlan& plan);

  // The pixel of the frame where the wall shows a point (eye coordinates, metres): its middle is at
  // x + 0.5, y + 0.5. Nothing where no wall tile does.
  std::optional<Eigen::Vector2i> pixelOf(const Eigen::Vector3f& at_eye_m) const;

  // Where the disc is drawn from now on; nowhere at first.
  void pointAt(const std::optional<Eigen::Vector3f>& at_eye_m) { at_eye_m_ = at_eye_m; }

  bool hasChanged() const override;
  // Draws the disc around that pixel, over the seams of wall tiles too. Cost: microseconds.
  void draw(std::span<std::uint8_t> canvas) override;
  void erase(std::span<std::uint8_t> canvas) override;

 private:
  struct Covered {
    std::size_t at;  // of the pixel, bytes
    std::uint8_t rgb[3];
  };
  void drawIn(const Tile& tile, const Eigen::Vector3f& at_eye_m, std::span<std::uint8_t> pixels);

  const TilePlan& plan_;
  std::optional<Eigen::Vector3f> at_eye_m_;
  std::optional<Eigen::Vector2i> drawn_;
  std::vector<Covered> covered_;
};

}  // namespace merlin::render
