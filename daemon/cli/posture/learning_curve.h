// Formats the learning curve of a training as text for a terminal and as an SVG chart.
#pragma once

#include <span>
#include <string>

#include "nn/fit.h"

namespace merlin::cli {

// Returns a table of about ten lines: number of the pass, training and validation error (mean
// squared), noise, and a bar for the training error on a logarithmic scale.
std::string curveText(std::span<const nn::CurvePoint> curve);

// Returns an SVG chart of the training and validation error over the passes, with a logarithmic
// error axis.
std::string curveSvg(std::span<const nn::CurvePoint> curve, const std::string& title);

}  // namespace merlin::cli
