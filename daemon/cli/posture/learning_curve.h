// A learning curve as text for a terminal and as an SVG picture.
#pragma once

#include <span>
#include <string>

#include "nn/fit.h"

namespace merlin::cli {

// About ten lines: pass, training and validation error, noise, and a bar of the training error on a
// logarithmic scale.
std::string curveText(std::span<const nn::CurvePoint> curve);

// Training and validation error over the passes, on a logarithmic scale.
std::string curveSvg(std::span<const nn::CurvePoint> curve, const std::string& title);

}  // namespace merlin::cli
