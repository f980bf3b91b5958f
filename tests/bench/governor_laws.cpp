#include "tests/bench/governor_laws.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "tests/support/governor_plant.h"

namespace merlin::bench {
namespace {

using test::kPeriod_s;

// [GOURLEY98] figure 5.36: the law counts the triangles drawn within a second. Divided by the
// desired rate, this number is the next resolution, unless the change is within a tolerance (5 per
// cent here; the text gives none).
class Law1998 final : public Law {
 public:
  void observe(double work_s) override {
    second_ += work_s;
    drawn_ += triangles_;
    if (second_ < 1) return;
    const double wanted = drawn_ / second_ * kPeriod_s;
    if (std::abs(wanted / triangles_ - 1) > 0.05) set(wanted);
    second_ = drawn_ = 0;
  }

 private:
  double second_ = 0, drawn_ = 0;
};

// Equalizer, eq/server/equalizers/dfrEqualizer.cpp: each axis of the image is scaled by the square
// root of actual / desired rate, damped by a half. Here triangles take the place of pixels.
class Equalizer final : public Law {
 public:
  void observe(double work_s) override {
    const double axis = 1 + 0.5 * (std::sqrt(kPeriod_s / work_s) - 1);
    set(triangles_ * axis * axis);
  }
};

// Unreal Engine's dynamic resolution, as its console variables document it: 10 per cent of head
// room, a weighted history of 16 frames, 8 frames between changes, only changes of more than 2 per
// cent. Two frames over budget in a row cause a change at once.
class Unreal final : public Law {
 public:
  void observe(double work_s) override {
    history_.push_front(work_s);
    if (history_.size() > 16) history_.pop_back();
    ++since_;
    over_ = work_s > kPeriod_s ? over_ + 1 : 0;
    if (over_ >= 2) return change(std::min(1.0, kAim_s / work_s));
    if (since_ < 8) return;
    double sum = 0, weights = 0, weight = 1;
    for (const double work : history_) {
      sum += weight * work;
      weights += weight;
      weight *= 0.9;
    }
    double ratio = kAim_s / (sum / weights);
    if (ratio > 1) ratio = 1 + 0.9 * (ratio - 1);
    if (std::abs(ratio - 1) > 0.02) change(ratio);
  }

 private:
  static constexpr double kAim_s = 0.9 * kPeriod_s;
  void change(double ratio) {
    set(triangles_ * ratio);
    history_.clear();
    since_ = over_ = 0;
  }
  std::deque<double> history_;
  int since_ = 99, over_ = 0;
};

// ParaView: while the model moves, it shows a decimated copy of a fixed size that a user chose;
// here the size that takes 4/5 of the period on this machine without load.
class TwoLevels final : public Law {
 public:
  TwoLevels() { set(4e6 * std::pow((0.8 * kPeriod_s - 0.004) / 0.232, 1 / 0.62)); }
  void observe(double) override {}
};

template <typename T>
NamedLaw named(std::string name) {
  return {std::move(name), [] { return std::make_unique<T>(); }};
}

}  // namespace

void Law::set(double triangles) { triangles_ = std::clamp(triangles, 500.0, 4e6); }

std::vector<NamedLaw> otherLaws() {
  return {named<Law1998>("of 1998"), named<Equalizer>("Equalizer DFR"),
          named<Unreal>("Unreal's dynamic"), named<TwoLevels>("two fixed levels")};
}

}  // namespace merlin::bench
