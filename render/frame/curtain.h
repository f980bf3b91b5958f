// Curtain: an overlay that darkens the whole canvas, down to black.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/frame/overlay.h"

namespace merlin::render::frame {

// Thread-bound to the wall's thread.
class Curtain final : public Overlay {
 public:
  // Sets the share of the full light that is shown from now on, 0 (black) to 1 (the canvas itself,
  // as initially). It is the same share for all pixels on outputs of gamma 2.2.
  void setLight(float share);

  bool hasChanged() const override { return factor_ != drawn_; }
  // Costs two passes over the canvas, and erase() one; nothing at full light. Allocates a copy of
  // the canvas when it is used for the first time.
  void draw(std::span<std::uint8_t> canvas) override;
  void erase(std::span<std::uint8_t> canvas) override;

 private:
  static constexpr std::uint32_t kFull = 256;
  std::uint32_t factor_ = kFull, drawn_ = kFull;  // factor on pixel values, in 1/256
  std::vector<std::uint8_t> covered_;             // pixels of the canvas before draw()
};

}  // namespace merlin::render::frame
