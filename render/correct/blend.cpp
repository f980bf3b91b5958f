#include "render/correct/blend.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace merlin::render::correct {
namespace {

double rampAt(double distance, double width) { return width > 0 ? ramp(distance / width) : 1; }

// Returns the share of a pixel, centred at `distance` from the border, that lies within the ramp
// [px].
double within(double distance, double width) {
  return width > 0 ? std::clamp(width - distance + 0.5, 0.0, 1.0) : 0;
}

}  // namespace

double ramp(double t) { return 0.5 - 0.5 * std::cos(std::numbers::pi * std::clamp(t, 0.0, 1.0)); }

double blendGain(const BlendSettings& b, double x, double y, double width, double height) {
  return rampAt(x, b.left) * rampAt(width - x, b.right) * rampAt(y, b.top) *
         rampAt(height - y, b.bottom);
}

double blackShare(const BlendSettings& b, double x, double y, double width, double height) {
  const double beside = std::min(1.0, within(x, b.left) + within(width - x, b.right));
  const double above = std::min(1.0, within(y, b.top) + within(height - y, b.bottom));
  const double most = (b.left > 0 || b.right > 0 ? 2 : 1) * (b.top > 0 || b.bottom > 0 ? 2 : 1);
  return most > 1 ? (most - (1 + beside) * (1 + above)) / (most - 1) : 0;
}

}  // namespace merlin::render::correct
