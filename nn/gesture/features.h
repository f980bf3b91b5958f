// Features of a stroke: the input of a recogniser. Pure.
//
// In the manner of D. Rubine, "Specifying gestures by example", SIGGRAPH 1991, for a path in space
// with the roll of the hand as a fourth coordinate; README.md says what differs.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "nn/gesture/pace.h"
#include "nn/gesture/stroke.h"

namespace merlin::nn {

// In this order in files; a change needs a new version of the file.
inline constexpr const char* kFeatureNames[] = {
    "right",        // way from first to last point to the right, share of the path's length
    "up",           // the same, up
    "towards",      // the same, from the wall to the person
    "roll",         // the same, of the hand's roll times kRollLever_m; clockwise
    "turning",      // turns of the path's direction in the wall's plane; clockwise
    "area",         // area that the path encloses in that plane, share of a circle's of its length
    "bend",         // greatest distance from the line from first to last point, share of the length
    "log_length",   // natural logarithm of the path's length [m], way and roll together
    "log_seconds",  // natural logarithm of its duration [s]
    "log_speed",    // natural logarithm of its greatest speed [m/s]
    "evenness",     // mean speed, share of the greatest
    "calm",         // speed in the 0.2 s before, share of the greatest
    "haste",        // log_speed minus that of this person's usual strokes of the length
};
inline constexpr std::size_t kFeatures = std::size(kFeatureNames);
using StrokeFeatures = std::array<float, kFeatures>;
inline constexpr std::size_t kRoll = 3, kLogLength = 7, kLogSpeed = 9;  // their places
static_assert(std::string_view(kFeatureNames[kRoll]) == "roll" &&
              std::string_view(kFeatureNames[kLogLength]) == "log_length" &&
              std::string_view(kFeatureNames[kLogSpeed]) == "log_speed");

// `calm_m_s`: StrokeFinder::calmBefore_m_s(). Nothing for a path that has no length. Cost: linear
// in the points, of which a StrokeFinder has at most 640; allocation-free.
std::optional<StrokeFeatures> featuresOf(std::span<const PathPoint> stroke, float calm_m_s,
                                         const UsualPace& pace) noexcept;

}  // namespace merlin::nn
