// ./dev bench gesture: the shipped gestures, tested on people who influenced neither the training
// nor any other choice. Measures rates and confusions, gestures that are reported in hours of
// ordinary motion (compared with the nearest template without rejection), a training from few takes
// of one person, and the cost for a pose.
//
// All people are synthetic. Absolute times differ between machines; the ratios are between times of
// one run.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "nn/gesture/evaluation.h"
#include "nn/io/gesture_file.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/bench/nanoseconds.h"
#include "tests/nn/moving.h"

namespace merlin::bench {
namespace {

constexpr std::uint64_t kFirst = 7001;  // people from this number on have influenced no choice
constexpr std::size_t kPeople = 60, kTimes = 5, kOrdinaryPeople = 60, kKindPeople = 20;
constexpr double kOrdinary_s = 1200, kKind_s = 600, kAfterTake_s = 0.8;
constexpr std::uint64_t kSeed = 77;

// Evaluates one person after another, so that recordings of many hours are never in memory
// together.
template <typename Record>
nn::GestureEvaluation evaluateAll(const nn::GestureModel& model, std::size_t people,
                                  Record record) {
  nn::GestureEvaluation evaluation;
  for (std::uint64_t n = kFirst; n < kFirst + people; ++n)
    nn::evaluateGestures(record(n), model, evaluation);
  return evaluation;
}

void confusions(const nn::GestureModel& model, const nn::GestureEvaluation& e, Report& report) {
  report.text("\n  meant \\ reported        ");
  for (std::size_t k = 0; k < model.gestures.size(); ++k) report.text("{:>5}", k + 1);
  report.text(" none   right\n");
  for (std::size_t k = 0; k < model.gestures.size(); ++k) {
    const std::string& meant = model.gestures[k].name;
    const auto row = e.confusion.find(meant);
    if (row == e.confusion.end()) continue;
    report.text("  {:2} {:23}", k + 1, meant);
    const auto cell = [&](const std::string& reported) {
      const auto found = row->second.find(reported);
      return found == row->second.end() ? std::size_t{0} : found->second;
    };
    for (const nn::TrainedGesture& other : model.gestures)
      report.text("{:>5}", cell(other.name) > 0 ? std::to_string(cell(other.name)) : ".");
    const nn::GestureScore& score = e.of.at(meant);
    const Measured rate = shareOf(score.right, score.takes, "takes");
    report.text("{:5}  {:5.1f} %\n", cell(""), 100 * rate);
    report.figure("accuracy." + meant, rate, "1");
  }
}

Measured perTenMinutes(const nn::GestureEvaluation& e) {
  if (!(e.ordinary_s > 0)) didNotRun("ordinary motion", "none was made", "see drivers/hand");
  return Measured::of(e.inventedPerTenMinutes(), static_cast<std::uint64_t>(e.ordinary_s),
                      "seconds");
}

// Returns whether the figures are within the limits that MERLIN promises.
bool held(const nn::GestureModel& model, Report& report) {
  const auto gestures = evaluateAll(
      model, kPeople, [](std::uint64_t n) { return nn::test::gesturesOf(n, 1, kTimes, kSeed); });
  const Measured rate = shareOf(gestures.all.right, gestures.all.takes, "takes");
  report.text(
      "{} people never seen (synthetic), {} takes of each gesture: {:.2f} % of {} right, {} "
      "missed, {} another, {} several; between them {} invented in {:.0f} s\n",
      kPeople, kTimes, 100 * rate, gestures.all.takes, gestures.all.missed, gestures.all.wrong,
      gestures.all.repeated, gestures.invented, gestures.ordinary_s);
  report.figure("accuracy", rate, "1");
  report.figure("invented_between_gestures_per_10_min", perTenMinutes(gestures), "1");
  confusions(model, gestures, report);
  note("ordinary motion");
  const auto ordinary = evaluateAll(model, kOrdinaryPeople, [](std::uint64_t n) {
    return nn::test::ordinaryOf(n, 1, kOrdinary_s, kSeed);
  });
  const Measured invented = perTenMinutes(ordinary);
  report.text("\nordinary motion, {:.1f} hours: {} gestures invented, {:.2f} in ten minutes\n",
              ordinary.ordinary_s / 3600, ordinary.invented, invented.value());
  report.figure("invented_per_10_min", invented, "1");
  return rate >= 0.97 && invented <= 1;
}

void kinds(const nn::GestureModel& model, Report& report) {
  report.text("  nothing but one kind of it, in ten minutes:");
  for (std::size_t kind = 0; kind < hand::kOrdinaryKinds; ++kind) {
    const auto e = evaluateAll(model, kKindPeople, [&](std::uint64_t n) {
      return nn::test::ordinaryOf(static_cast<hand::Ordinary>(kind), n, 1, kKind_s, kSeed);
    });
    const Measured invented = perTenMinutes(e);
    report.text(" {} {:.2f};", hand::kOrdinaryNames[kind], invented.value());
    report.figure(fmt::format("invented_per_10_min.{}", hand::kOrdinaryNames[kind]), invented, "1");
  }
  report.text("\n");
}

// The path of a stroke, resampled at equal lengths, moved so that its middle is the origin, and
// scaled to size 1.
constexpr std::size_t kTemplatePoints = 16;
using Template = std::array<float, 4 * kTemplatePoints>;

Template templateOf(std::span<const nn::PathPoint> stroke) {
  std::vector<std::array<float, 4>> at;
  std::vector<float> way{0};
  for (const nn::PathPoint& p : stroke) {
    at.push_back(
        {p.position_m[0], p.position_m[1], p.position_m[2], nn::kRollLever_m * p.roll_rad});
    if (at.size() == 1) continue;
    const auto &a = at[at.size() - 2], &b = at.back();
    way.push_back(way.back() + std::hypot(std::hypot(b[0] - a[0], b[1] - a[1]),
                                          std::hypot(b[2] - a[2], b[3] - a[3])));
  }
  Template t{};
  std::array<float, 4> mean{};
  for (std::size_t n = 0, from = 0; n < kTemplatePoints; ++n) {
    const float goal = way.back() * static_cast<float>(n) / (kTemplatePoints - 1);
    while (from + 2 < way.size() && way[from + 1] < goal) ++from;
    const float step = way[from + 1] - way[from];
    const float share = step > 0 ? std::min((goal - way[from]) / step, 1.0F) : 0;
    for (std::size_t i = 0; i < 4; ++i) {
      t[4 * n + i] = at[from][i] + share * (at[from + 1][i] - at[from][i]);
      mean[i] += t[4 * n + i] / kTemplatePoints;
    }
  }
  float square = 1e-12F;
  for (std::size_t i = 0; i < t.size(); ++i) {
    t[i] -= mean[i % 4];
    square += t[i] * t[i];
  }
  for (float& v : t) v /= std::sqrt(square);
  return t;
}

struct LabelledTemplate {
  std::uint32_t label;
  Template path;
};

// Calls use(stroke, take) for each stroke of the recording. `take`: the take that contains most of
// the stroke, or null.
template <typename Use>
void eachStroke(const nn::PathRecording& recording, Use use) {
  for (const auto session : nn::sessionsOf(recording)) {
    const auto takes = nn::takesOf(session, recording);
    nn::StrokeFinder finder;
    for (const nn::LabelledPose& p : session) {
      const auto stroke = finder.update(p.pose);
      if (stroke.empty()) continue;
      const std::int64_t middle_ns = (stroke.front().at_ns + stroke.back().at_ns) / 2;
      const auto take = std::find_if(takes.begin(), takes.end(), [&](const nn::Take& t) {
        return t.first_ns <= middle_ns && middle_ns <= t.last_ns;
      });
      use(stroke, take == takes.end() ? nullptr : &*take);
    }
  }
}

// Evaluates the simplest method: each stroke is taken for the gesture of the nearest of 600
// templates.
void nearestTemplate(Report& report) {
  std::vector<LabelledTemplate> templates;
  const nn::PathRecording train = nn::test::gesturesOf(1, 20, 3, 1);
  eachStroke(train, [&](std::span<const nn::PathPoint> stroke, const nn::Take* take) {
    if (take) templates.push_back({take->label, templateOf(stroke)});
  });
  const auto nearest = [&](std::span<const nn::PathPoint> stroke) {
    const Template path = templateOf(stroke);
    const auto distance = [&](const LabelledTemplate& t) {
      float sum = 0;
      for (std::size_t i = 0; i < path.size(); ++i)
        sum += (path[i] - t.path[i]) * (path[i] - t.path[i]);
      return sum;
    };
    return std::min_element(templates.begin(), templates.end(),
                            [&](const auto& a, const auto& b) { return distance(a) < distance(b); })
        ->label;
  };
  if (templates.empty()) didNotRun("the templates", "no stroke", "see nn/gesture");
  std::size_t strokes = 0, right = 0, invented = 0;
  const nn::PathRecording test = nn::test::gesturesOf(kFirst, 20, kTimes, kSeed);
  eachStroke(test, [&](std::span<const nn::PathPoint> stroke, const nn::Take* take) {
    if (!take) return;
    ++strokes;
    if (train.labels[nearest(stroke)] == test.labels[take->label]) ++right;
  });
  const nn::PathRecording ordinary = nn::test::ordinaryOf(kFirst, 6, kKind_s, kSeed);
  eachStroke(ordinary, [&](std::span<const nn::PathPoint>, const nn::Take*) { ++invented; });
  const Measured rate = shareOf(right, strokes, "strokes");
  const Measured ten = Measured::of(static_cast<double>(invented) / 6, 6, "ten minutes");
  report.text(
      "\nbeside it, the nearest of {} templates without rejection: {:.2f} % of the strokes of a "
      "gesture right; {:.0f} invented in ten minutes\n",
      templates.size(), 100 * rate, ten.value());
  report.figure("nearest_template.accuracy", rate, "1");
  report.figure("nearest_template.invented_per_10_min", ten, "1");
}

// Evaluates rejection by the limits of distance alone, without the discriminants.
void withoutDiscriminant(nn::GestureModel model, Report& report) {
  for (nn::TrainedGesture& gesture : model.gestures) gesture.discriminant.reset();
  nn::GestureEvaluation e;
  for (std::uint64_t n = kFirst; n < kFirst + kKindPeople; ++n) {
    nn::evaluateGestures(nn::test::gesturesOf(n, 1, kTimes, kSeed), model, e);
    nn::evaluateGestures(nn::test::ordinaryOf(n, 1, kKind_s, kSeed), model, e);
  }
  const Measured rate = shareOf(e.all.right, e.all.takes, "takes");
  const Measured invented = perTenMinutes(e);
  report.text("rejection by distance alone: {:.2f} % right, {:.1f} invented in ten minutes\n",
              100 * rate, invented.value());
  report.figure("without_discriminant.accuracy", rate, "1");
  report.figure("without_discriminant.invented_per_10_min", invented, "1");
}

// Evaluates a training in which one person records five takes of each gesture; ordinary motion of
// 20 other people is added.
void fewTakes(Report& report) {
  std::size_t lost = 0;
  std::vector<nn::LabelledStroke> ordinary;
  for (std::uint64_t n = 1; n <= 20; ++n) {
    for (auto& stroke : nn::strokesOf(nn::test::ordinaryOf(n, 1, kKind_s, 1), kAfterTake_s, lost))
      ordinary.push_back(std::move(stroke));
  }
  nn::GestureEvaluation own, others;
  for (std::uint64_t n = kFirst; n < kFirst + kKindPeople; ++n) {
    auto strokes = nn::strokesOf(nn::test::gesturesOf(n, 1, 5, 1), kAfterTake_s, lost);
    strokes.insert(strokes.end(), ordinary.begin(), ordinary.end());
    const auto model = nn::trainGestures(strokes, {});
    if (!model) didNotRun("the training", model.error().what, "see nn/gesture/README.md");
    nn::evaluateGestures(nn::test::gesturesOf(n, 1, kTimes, kSeed), *model, own);
    nn::evaluateGestures(nn::test::ordinaryOf(n, 1, kKind_s, kSeed), *model, own);
    nn::evaluateGestures(nn::test::gesturesOf(n + 100, 1, kTimes, kSeed), *model, others);
  }
  const Measured rate = shareOf(own.all.right, own.all.takes, "takes"),
                 other = shareOf(others.all.right, others.all.takes, "takes"),
                 invented = perTenMinutes(own);
  report.text(
      "trained from five takes of one person: {:.2f} % of this person's next right, {:.2f} % of "
      "another's; {:.2f} invented in ten minutes\n",
      100 * rate, 100 * other, invented.value());
  report.figure("few_takes.accuracy", rate, "1");
  report.figure("few_takes.accuracy.others", other, "1");
  report.figure("few_takes.invented_per_10_min", invented, "1");
}

void cost(const nn::GestureModel& model, Report& report) {
  const nn::PathRecording recording = nn::test::gesturesOf(kFirst, 1, 3, kSeed);
  const auto& poses = recording.poses;
  nn::GestureFollower follower(model);
  volatile std::size_t sink = 0;
  std::int64_t shift_ns = 0;
  std::size_t next = 0;
  const Measured pose = nanoseconds([&](std::size_t) {
    nn::HandPose p = poses[next].pose;
    p.at_ns += shift_ns;
    if (follower.update(p)) sink = sink + 1;
    if (++next < poses.size()) return;
    next = 0;
    shift_ns += poses.back().pose.at_ns - poses.front().pose.at_ns + 10'000'000;
  });
  // The longest possible stroke needs the most work for a single pose.
  std::vector<nn::PathPoint> longest(600);
  for (std::size_t n = 0; n < longest.size(); ++n) {
    const auto t = static_cast<float>(n) * 0.01F;
    longest[n] = {static_cast<std::int64_t>(n) * 7'000'000, {std::sin(t), std::cos(t), t}, t, 1};
  }
  const nn::GestureRecogniser recognise(model);
  const Measured end = nanoseconds([&](std::size_t) {
    const auto features = nn::featuresOf(longest, 0.1F, {});
    sink = recognise(features.value_or(nn::StrokeFeatures{})).nearest;
  });
  report.text("a pose: {:.0f} ns; the end of the longest stroke: {:.1f} us\n", pose.value(),
              1e-3 * end);
  report.figure("pose", pose, "ns");
  report.figure("stroke_end", end, "ns");
}

bool run(Report& report) {
  const std::string path = MERLIN_SOURCE_DIR "/config/gestures.json";
  const auto file = nn::loadGestures(path);
  if (!file) didNotRun(path, file.error().what, "merlin gesture train -o config/gestures.json");
  note("gestures of people never seen");
  const bool good = held(file->model, report);
  kinds(file->model, report);
  note("comparisons");
  nearestTemplate(report);
  withoutDiscriminant(file->model, report);
  note("few takes");
  fewTakes(report);
  cost(file->model, report);
  return good;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::CommandLine app(
      "Gestures: rates, confusions, false reports, training from few takes, cost.");
  return app.run("gesture", argc, argv, merlin::bench::run);
}
