// A simulated renderer for the governor's tests and benchmark. On a virtual clock, a formula gives
// the time that a frame takes, under a load given by a trace. Also computes the figures for which
// MERLIN states limits (late frames, settling time, oscillation).
//
// A frame of T triangles takes (a + f c T^p) e^noise seconds. The trace gives a and the factor f; c
// and p were fitted to four views of 640 x 480 pixels on llvmpipe (4,000,000 triangles: 236 ms);
// the noise has a standard deviation of 3 per cent. The share Plant::hiccups of the frames has a
// hiccup, which adds 5 to 20 ms. For one seed, a frame's noise is the same under every control law.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <numeric>
#include <vector>

#include "daemon/base/random.h"
#include "render/governor/governor.h"

namespace merlin::test {

inline constexpr double kPeriod_s = 1.0 / 30;
inline constexpr std::size_t kFrames = 1200, kStep = 300, kRelease = 600;
// The first second [frames] is not counted, since no control law knows the machine's speed yet.
inline constexpr std::size_t kFirstSecond = 30;

struct Load {
  double fixed_s = 0.004, factor = 1;
};
using Trace = std::vector<Load>;

inline Trace steadyTrace() { return Trace(kFrames); }
// Returns a trace in which, from frame kStep to frame kRelease, a triangle costs `ratio` times as
// much and the fixed part of a frame is `fixed_s` [s].
inline Trace stepTrace(double ratio, double fixed_s = 0.004) {
  Trace trace(kFrames);
  std::fill(trace.begin() + kStep, trace.begin() + kRelease, Load{fixed_s, ratio});
  return trace;
}
// Returns a trace in which the cost of a triangle rises to twice its value and falls again, with a
// period of four seconds.
inline Trace rampTrace() {
  Trace trace(kFrames);
  for (std::size_t i = 0; i < kFrames; ++i) {
    const double wave = std::sin(2 * std::numbers::pi * static_cast<double>(i) / 240);
    trace[i].factor = 1 + wave * wave;
  }
  return trace;
}

struct Plant {
  Trace trace;
  std::uint64_t seed = 1;
  double hiccups = 0;  // share of the frames that have a hiccup, 0..1
  double exponent = 0.62;
  double noise = 0.03;

  render::governor::FrameCost draw(std::size_t frame, std::size_t triangles) const {
    Random random(seed * 1'000'003 + frame);
    const Load& load = trace[std::min(frame, trace.size() - 1)];
    const double scale = std::exp(noise * random.normal());
    const double full = 0.232 * std::pow(static_cast<double>(triangles) / 4e6, exponent);
    double work = (load.fixed_s + load.factor * full) * scale;
    if (random.uniform() < hiccups) work += random.uniform(0.005, 0.020);
    return {triangles, fromSeconds(load.fixed_s * scale), fromSeconds(work), false};
  }
};

// The result of a simulation, with one entry in each list for each deadline.
struct Outcome {
  std::vector<double> triangles, work_s;
  std::vector<bool> late;

  void add(double t, double work, bool was_late) {
    triangles.push_back(t);
    work_s.push_back(work);
    late.push_back(was_late);
  }
};

// Paces frames as the wall does (daemon/wall/wall_loop.h): frames begin on a grid of periods. A
// frame that overruns misses every deadline that passes meanwhile; the next frame begins at once
// and has only the rest of its period.
inline Outcome runOnGrid(render::governor::Governor& governor, const Plant& plant) {
  Outcome out;
  double finished = 0;
  for (std::size_t k = 0; k < plant.trace.size();) {
    const double tick = static_cast<double>(k) * kPeriod_s, begin = std::max(finished, tick);
    const std::size_t fits = governor.budgetFor(fromSeconds(tick + kPeriod_s - begin));
    if (fits == 0) {
      out.add(out.triangles.empty() ? 0 : out.triangles.back(), kPeriod_s, true);
      ++k;
      continue;
    }
    render::governor::FrameCost cost = plant.draw(k, fits);
    finished = begin + toSeconds(cost.work);
    cost.late = finished > tick + kPeriod_s;
    governor.observe(cost);
    const double last_tick = std::floor(finished / kPeriod_s);
    const std::size_t next = std::max(k + 1, static_cast<std::size_t>(last_tick));
    for (; k < next; ++k) {
      const double passed = static_cast<double>(k + 1) * kPeriod_s;
      out.add(static_cast<double>(fits), toSeconds(cost.work), finished > passed);
    }
  }
  return out;
}

// Judges each frame alone: it is late when its own work exceeds the period. This is milder than the
// grid, where an overrun shortens the next frame.
inline Outcome runAlone(const std::function<double()>& triangles,
                        const std::function<void(double work_s)>& observe, const Plant& plant) {
  Outcome out;
  for (std::size_t k = 0; k < plant.trace.size(); ++k) {
    const double t = triangles();
    const double work = toSeconds(plant.draw(k, static_cast<std::size_t>(t)).work);
    out.add(t, work, work > kPeriod_s);
    observe(work);
  }
  return out;
}

inline double lateShare(const Outcome& o) {
  const auto late = std::count(o.late.begin() + kFirstSecond, o.late.end(), true);
  return static_cast<double>(late) / static_cast<double>(o.late.size() - kFirstSecond);
}

inline std::size_t longestLate(const Outcome& o) {
  std::size_t run = 0, longest = 0;
  for (std::size_t i = kFirstSecond; i < o.late.size(); ++i) {
    run = o.late[i] ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

inline double utilisation(const Outcome& o) {
  double sum = 0;
  for (std::size_t i = kFirstSecond; i < o.work_s.size(); ++i)
    sum += std::min(o.work_s[i] / kPeriod_s, 1.0);
  return sum / static_cast<double>(o.work_s.size() - kFirstSecond);
}

// Number of frames from `from` to the first of five consecutive frames for which `good` holds;
// `end` - `from` if there are none.
inline std::size_t framesUntil(std::size_t from, std::size_t end,
                               const std::function<bool(std::size_t)>& good) {
  std::size_t in_a_row = 0;
  for (std::size_t i = from; i < end; ++i) {
    in_a_row = good(i) ? in_a_row + 1 : 0;
    if (in_a_row == 5) return i - 4 - from;
  }
  return end - from;
}

inline std::size_t framesToSettle(const Outcome& o) {
  return framesUntil(kStep, kRelease, [&](std::size_t i) { return !o.late[i]; });
}

// Number of frames after the end of the step in the load until 90 per cent of the triangles before
// the step are drawn again.
inline std::size_t framesToRecover(const Outcome& o) {
  const auto* t = o.triangles.data();
  const double before = std::accumulate(t + kStep - 100, t + kStep, 0.0) / 100;
  return framesUntil(kRelease, o.triangles.size(),
                     [&](std::size_t i) { return o.triangles[i] >= 0.9 * before; });
}

// Mean of (p95 - p5) / mean of the triangle counts, over windows of 100 frames.
inline double oscillation(const Outcome& o) {
  double sum = 0;
  std::size_t windows = 0;
  for (std::size_t first = 100; first + 100 <= o.triangles.size(); first += 100, ++windows) {
    std::vector<double> w(o.triangles.begin() + static_cast<std::ptrdiff_t>(first),
                          o.triangles.begin() + static_cast<std::ptrdiff_t>(first + 100));
    std::sort(w.begin(), w.end());
    sum += (w[94] - w[5]) / (std::accumulate(w.begin(), w.end(), 0.0) / 100);
  }
  return sum / static_cast<double>(windows);
}

}  // namespace merlin::test
