// A learning curve as text for a terminal and as an SVG picture.
#pragma once

#include <span>
#include <string>

#include "nn/fit.h"

namespace merlin::cli {

// About ten lines: pass, both errors, noise, a bar of the error on a logarithmic scale.
std::string curveText(std::span<const nn::CurvePoint> curve);

// Both errors over the passes, the errors on a logarithmic scale.
std::string curveSvg(std::span<const nn::CurvePoint> curve, const std::string& title);

}  // namespace merlin::cli
