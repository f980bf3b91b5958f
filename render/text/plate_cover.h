// PlateCover: puts plates over a canvas, and restores what they covered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/text/operator_plate.h"

namespace merlin::render::text {

// Thread-bound. Keeps its memory from frame to frame.
class PlateCover {
 public:
  // For a canvas of this width [px], RGBA, rows from top to bottom.
  explicit PlateCover(int canvas_width_px) : width_(static_cast<std::size_t>(canvas_width_px)) {}

  // Blends a plate onto the canvas; `tile`: its tile in the canvas. REQUIRES: the plate lies in the
  // tile, and the tile in the canvas. Costs about three copies of the plate.
  void put(const Plate& plate, const Rect& tile, std::span<std::uint8_t> canvas);

  // Restores the pixels under all plates since the last call, the last plate first. REQUIRES: see
  // frame::Overlay::erase(). Costs a copy of the plates.
  void erase(std::span<std::uint8_t> canvas);

 private:
  template <typename Act>
  void forEachRow(const Rect& at, const Act& act) const;

  std::size_t width_;
  std::vector<Rect> put_;              // in the canvas
  std::vector<std::uint8_t> covered_;  // the canvas's pixels under them
};

}  // namespace merlin::render::text
