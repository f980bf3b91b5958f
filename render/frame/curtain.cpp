#include "render/frame/curtain.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace merlin::render::frame {

void Curtain::setLight(float share) {
  constexpr float kGamma = 2.2F;
  const float factor = std::pow(std::clamp(share, 0.0F, 1.0F), 1 / kGamma);
  factor_ = static_cast<std::uint32_t>(std::lround(factor * static_cast<float>(kFull)));
}

void Curtain::draw(std::span<std::uint8_t> canvas) {
  drawn_ = factor_;
  if (drawn_ == kFull) return;
  covered_.assign(canvas.begin(), canvas.end());
  const std::uint32_t factor = drawn_;
  // Red and blue are scaled at once, then green; alpha, the uppermost byte, stays.
  for (std::size_t i = 0; i + 4 <= canvas.size(); i += 4) {
    std::uint32_t pixel = 0;
    std::memcpy(&pixel, &canvas[i], sizeof pixel);
    const std::uint32_t red_blue = ((pixel & 0x00FF00FFU) * factor >> 8) & 0x00FF00FFU;
    const std::uint32_t green = ((pixel & 0x0000FF00U) * factor >> 8) & 0x0000FF00U;
    pixel = (pixel & 0xFF000000U) | red_blue | green;
    std::memcpy(&canvas[i], &pixel, sizeof pixel);
  }
}

void Curtain::erase(std::span<std::uint8_t> canvas) {
  if (drawn_ != kFull) std::copy(covered_.begin(), covered_.end(), canvas.begin());
}

}  // namespace merlin::render::frame
