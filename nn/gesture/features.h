// Features of a stroke: the input of a recogniser. Pure.
//
// The features follow D. Rubine, "Specifying gestures by example", SIGGRAPH 1991, for a path in
// space with the roll of the hand as a fourth coordinate; README.md lists the differences.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "nn/gesture/pace.h"
#include "nn/gesture/stroke.h"

namespace merlin::nn {

// The order of the features in StrokeFeatures and in gesture files; a change needs a new version of
// the file format.
inline constexpr const char* kFeatureNames[] = {
    "right",        // displacement to the right, from first to last point / path length
    "up",           // displacement upwards, from first to last point / path length
    "towards",      // displacement away from the wall, from first to last point / path length
    "roll",         // clockwise roll of the hand times kRollLever_m / path length
    "turning",      // full turns of the path's direction in the wall's plane; clockwise
    "area",         // area enclosed in the wall's plane / area of a circle of that perimeter
    "bend",         // greatest distance from the line through both end points / path length
    "log_length",   // natural logarithm of the path's length [m], roll included
    "log_seconds",  // natural logarithm of the stroke's duration [s]
    "log_speed",    // natural logarithm of the stroke's greatest speed [m/s]
    "evenness",     // mean speed / greatest speed
    "calm",         // speed in the 0.2 s before the stroke / greatest speed
    "haste",        // log_speed minus that of this person's usual strokes of this length
};
inline constexpr std::size_t kFeatures = std::size(kFeatureNames);
using StrokeFeatures = std::array<float, kFeatures>;
inline constexpr std::size_t kRoll = 3, kLogLength = 7, kLogSpeed = 9;  // indices of these features
static_assert(std::string_view(kFeatureNames[kRoll]) == "roll" &&
              std::string_view(kFeatureNames[kLogLength]) == "log_length" &&
              std::string_view(kFeatureNames[kLogSpeed]) == "log_speed");

// Returns the features of a stroke; nothing if it has fewer than 3 points, is at most 2 cm long,
// has no duration, or has a feature that is not finite. `calm_m_s`: StrokeFinder::calmBefore_m_s()
// after the stroke. Cost: linear in the points, of which a StrokeFinder has at most 640;
// allocation-free.
std::optional<StrokeFeatures> featuresOf(std::span<const PathPoint> stroke, float calm_m_s,
                                         const UsualPace& pace) noexcept;

}  // namespace merlin::nn
