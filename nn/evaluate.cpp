#include "nn/evaluate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nn/fit.h"

namespace merlin::nn {
namespace {

double squaredDistance(const Input& a, const Input& b) {
  double sum = 0;
  for (std::size_t i = 0; i < kInputs; ++i) {
    const double d = static_cast<double>(a[i]) - static_cast<double>(b[i]);
    sum += d * d;
  }
  return sum;
}

std::size_t nearestOf(const std::vector<Input>& points, const Input& x) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < points.size(); ++n) {
    const double d = squaredDistance(points[n], x);
    if (d >= least) continue;
    least = d;
    best = n;
  }
  return best;
}

// Returns the hands' inputs scaled by `ranges`. Slots that never changed in training are set to 0.
std::vector<Input> scaled(std::span<const LabelledHand> hands, const InputRanges& ranges,
                          const Slots& used) {
  std::vector<Input> points;
  for (const LabelledHand& hand : hands) {
    Input x = normalise(ranges, hand.value);
    for (std::size_t i = 0; i < kInputs; ++i) x[i] = used[i] ? x[i] : 0.0F;
    points.push_back(x);
  }
  return points;
}

std::vector<Confusion> sorted(const std::map<std::pair<std::string, std::string>, std::size_t>& m) {
  std::vector<Confusion> list;
  for (const auto& [what, hands] : m) list.push_back({what.first, what.second, hands});
  std::stable_sort(list.begin(), list.end(),
                   [](const Confusion& a, const Confusion& b) { return a.hands > b.hands; });
  return list;
}

void count(Score& score, bool rejected, bool right) {
  ++score.total;
  score.rejected += rejected ? 1 : 0;
  score.right += right ? 1 : 0;
}

// `recognise`: a function of a hand's values that returns a Recognition.
template <typename Recognise>
Evaluation evaluateWith(Recognise& recognise, std::span<const LabelledHand> hands,
                        double least_margin) {
  Evaluation e;
  std::map<std::string, PostureScore> by_posture;
  std::map<std::pair<std::string, std::string>, std::size_t> confused;
  for (const LabelledHand& hand : hands) {
    const Recognition seen = recognise(hand.value);
    const double margin = static_cast<double>(seen.margin);
    const bool right = seen.name == hand.posture, sure = margin >= least_margin;
    count(e.all, seen.name.empty(), right);
    e.unsure += sure ? 0 : 1;
    e.right_and_sure += right && sure ? 1 : 0;
    PostureScore& p = by_posture[hand.posture];
    count(p.score, seen.name.empty(), right);
    if (right) {
      p.least_margin = std::min(p.least_margin, margin);
      p.mean_margin += margin;
    } else {
      ++confused[{hand.posture, std::string(seen.name)}];
    }
  }
  for (auto& [name, p] : by_posture) {
    p.posture = name;
    p.mean_margin /= static_cast<double>(std::max<std::size_t>(p.score.right, 1));
    if (p.score.right == 0) p.least_margin = 0;
    e.postures.push_back(p);
  }
  std::stable_sort(e.postures.begin(), e.postures.end(),
                   [](const PostureScore& a, const PostureScore& b) {
                     return a.score.accuracy() < b.score.accuracy();
                   });
  e.confusions = sorted(confused);
  return e;
}

}  // namespace

Evaluation evaluate(const PostureNetwork& network, std::span<const LabelledHand> hands,
                    double least_margin) {
  const Recogniser recognise(network);
  return evaluateWith(recognise, hands, least_margin);
}

Evaluation evaluate(DriftFollower& follower, std::span<const LabelledHand> hands,
                    double least_margin) {
  return evaluateWith(follower, hands, least_margin);
}

Neighbours neighbours(std::span<const LabelledHand> train, std::span<const LabelledHand> test) {
  std::vector<std::size_t> posture;
  const auto names = posturesOf(train, posture);
  Slots used{};
  const InputRanges ranges = rangesOf(train, kGloveRanges, used);
  const auto points = scaled(train, ranges, used);
  std::vector<Input> means(names.size(), Input{});
  for (std::size_t n = 0; n < points.size(); ++n) {
    const auto hands = static_cast<float>(std::count(posture.begin(), posture.end(), posture[n]));
    for (std::size_t i = 0; i < kInputs; ++i) means[posture[n]][i] += points[n][i] / hands;
  }
  const auto shown = scaled(test, ranges, used);
  std::size_t by_mean = 0, by_hand = 0;
  for (std::size_t n = 0; n < shown.size(); ++n) {
    by_mean += names[nearestOf(means, shown[n])] == test[n].posture ? 1U : 0U;
    by_hand += names[posture[nearestOf(points, shown[n])]] == test[n].posture ? 1U : 0U;
  }
  const auto all = static_cast<double>(std::max<std::size_t>(test.size(), 1));
  return {static_cast<double>(by_mean) / all, static_cast<double>(by_hand) / all};
}

std::vector<Overlap> overlapsOf(const std::string& posture, std::span<const LabelledHand> hands) {
  std::vector<std::size_t> index;
  const auto names = posturesOf(hands, index);
  const auto found = std::find(names.begin(), names.end(), posture);
  if (found == names.end()) return {};
  const auto own = static_cast<std::size_t>(found - names.begin());
  Slots used{};
  const InputRanges ranges = rangesOf(hands, kGloveRanges, used);
  std::vector<Input> x;
  for (const LabelledHand& hand : hands) x.push_back(normalise(ranges, hand.value));
  const WhitenedSpace space(statisticsOf(x, index, names, used), used);
  std::vector<Overlap> overlaps;
  for (std::size_t other = 0; other < names.size(); ++other) {
    if (other == own) continue;
    Overlap o{posture, names[other], 0, 0};
    const auto &a = space.means()[own], &b = space.means()[other];
    o.deviations = std::sqrt(squaredDistance(a, b)) / static_cast<double>(space.sigma());
    for (std::size_t n = 0; n < x.size(); ++n) {
      if (index[n] != own && index[n] != other) continue;
      const Input u = space.toSpace(x[n]);
      const bool nearer_a = squaredDistance(u, a) < squaredDistance(u, b);
      o.mixed_up += nearer_a == (index[n] == own) ? 0U : 1U;
    }
    if (o.deviations < kNearPostures || o.mixed_up > 0) overlaps.push_back(o);
  }
  std::sort(overlaps.begin(), overlaps.end(),
            [](const Overlap& a, const Overlap& b) { return a.deviations < b.deviations; });
  return overlaps;
}

}  // namespace merlin::nn
