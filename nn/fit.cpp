#include "nn/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "nn/codes.h"
#include "nn/descent.h"
#include "nn/start.h"

namespace merlin::nn {
namespace {

constexpr int kRestarts = 10;            // random starts of each assignment of codes
constexpr std::size_t kFirstRound = 20;  // passes of each start before the worse half is dropped
constexpr float kRate = 0.02F, kLastRate = 1e-5F;
// The noise grows while the error with noise is below this limit. Thus the network is trained with
// as much noise as it tolerates, which makes the margins between postures as wide as possible.
constexpr double kBearableError = 0.005;
constexpr float kNoiseStep = 1.05F, kFirstNoise = 0.7F, kLeastNoise = 0.35F, kMostNoise = 4.0F;
constexpr float kMostBeyond = 2.0F;  // limit of noise for hands that are nearer to another posture
// Number of passes between two evaluations of the validation hands.
constexpr std::size_t kEvaluationPeriod = 4;
// Number of evaluations without a lower error after which the descent ends.
constexpr std::size_t kPatience = 8;
constexpr std::size_t kLastPasses = 40;  // final passes, with the validation hands too
constexpr float kLastRates = 0.1F;       // rate of the final passes, share of kRate

struct Start {
  Descending at;
  double error = 0;
  std::vector<std::uint32_t> pool, codes;
};

// Working data of one call of fit().
class Fit {
 public:
  Fit(const FitSettings& settings, const FitProgress& progress, const WhitenedSpace& space)
      : settings_(settings), progress_(progress), space_(space), random_(settings.seed) {}

  // Takes the samples, in whitened coordinates. `kept[n]`: sample n is set aside for validation.
  void take(std::vector<Sample> all, const std::vector<bool>& kept) {
    all_ = std::move(all);
    for (std::size_t n = 0; n < all_.size(); ++n) (kept[n] ? aside_ : train_).push_back(all_[n]);
  }

  Start run() {
    Descent descent(settings_.phi, train_, space_.means(), Random(random_.next()));
    Start best = choose(descent);
    if (!stopped_) descend(best, descent);
    Descent everything(settings_.phi, all_, space_.means(), Random(random_.next()));
    for (std::size_t i = 0; i < kLastPasses && !stopped_; ++i)
      pass(best, everything, kLastRates * kRate * left(i, kLastPasses));
    best.error = meanError(settings_.phi, all_, best.at.weights, best.codes);
    return best;
  }

  std::vector<CurvePoint> takeCurve() { return std::move(curve_); }

 private:
  // Prefers a start with codes of even parity if the network can learn them.
  static double price(const Start& s) {
    const bool bearable = s.pool.size() < kCodes - 1 && s.error < kBearableError;
    return bearable ? s.error * 1e-3 : s.error;
  }

  static float left(std::size_t i, std::size_t of) {
    return 1 - static_cast<float>(i) / static_cast<float>(of);
  }

  static float shrinkFor(float noise) { return 1 / std::sqrt(1 + noise * noise); }

  double asideError(const Start& start) const {
    return meanError(settings_.phi, aside_, start.at.weights, start.codes);
  }

  std::size_t planned() const {
    std::size_t sum = settings_.passes + kLastPasses, length = kFirstRound;
    for (std::size_t n = settings_.starts; n > 1; n = fewer(n), length *= 2) sum += n * length;
    return sum;
  }
  static std::size_t fewer(std::size_t n) { return n > 4 ? (n + 2) / 3 : (n + 1) / 2; }

  double pass(Start& start, Descent& descent, float rate) {
    const float beyond = std::min(noise_, kMostBeyond);
    const double error = descent.pass(
        start.at, start.codes, rate,
        {noise_ * space_.sigma(), shrinkFor(noise_), beyond * space_.sigma(), shrinkFor(beyond)});
    const bool look = curve_.size() % kEvaluationPeriod == 0 && !aside_.empty();
    curve_.push_back({curve_.size() + 1, error, look ? asideError(start) : std::nan(""),
                      static_cast<double>(noise_)});
    const double share = static_cast<double>(curve_.size()) / static_cast<double>(planned());
    if (progress_ && !progress_(std::min(share, 1.0), curve_.back())) stopped_ = true;
    return error;
  }

  void adapt(double error) {
    noise_ = std::clamp(error < kBearableError ? noise_ * kNoiseStep : noise_ / kNoiseStep,
                        kLeastNoise, kMostNoise);
  }

  // Trains several starts and drops the worse half in each round.
  Start choose(Descent& descent) {
    const Likeness likeness = space_.likeness();
    std::vector<Start> starts(settings_.starts);
    for (std::size_t n = 0; n < starts.size(); ++n) {
      Start& s = starts[n];
      s.pool = codesFor(space_.means().size(), n % 2 == 0 ? Parity::kEven : Parity::kAny);
      s.codes = assignCodes(likeness, s.pool, kRestarts, random_);
      s.at.weights = startingWeights(space_.means(), s.codes, space_.sigma(), random_);
    }
    for (std::size_t length = kFirstRound; starts.size() > 1 && !stopped_; length *= 2) {
      for (Start& s : starts) firstPasses(s, descent, length);
      std::sort(starts.begin(), starts.end(),
                [](const Start& a, const Start& b) { return price(a) < price(b); });
      for (std::size_t i = 0; i < length; ++i) adapt(starts[starts.size() / 2].error);
      starts.resize(fewer(starts.size()));
    }
    return std::move(starts.front());
  }

  void firstPasses(Start& s, Descent& descent, std::size_t length) {
    constexpr std::size_t kCounted = 5;
    s.error = 0;
    for (std::size_t i = 0; i < length && !stopped_; ++i) {
      const double error = pass(s, descent, kRate);
      if (i + kCounted >= length) s.error += error / kCounted;
      if (i < length * 3 / 5) exchangeCodes(descent.meanOutputs(s.at.weights), s.pool, s.codes);
    }
  }

  // Trains with a falling rate and keeps the network that was best on the validation hands.
  void descend(Start& s, Descent& descent) {
    double least = std::numeric_limits<double>::infinity();
    PackedWeights<float> best = s.at.weights;
    std::size_t looks = 0;
    const std::size_t settled = settings_.passes * 4 / 5;
    for (std::size_t i = 0; i < settings_.passes && !stopped_; ++i) {
      const double error = pass(s, descent, kRate * left(i, settings_.passes) + kLastRate);
      // Until the noise has settled, no network is kept as the best, because the margins still grow
      // with the noise, which the error without noise does not show.
      if (i < settled) {
        adapt(error);
        continue;
      }
      if (i % kEvaluationPeriod != 0 && i + 1 != settings_.passes) continue;
      const double now = aside_.empty() ? error : asideError(s);
      if (now < least) {
        least = now;
        best = s.at.weights;
        looks = 0;
      } else if (++looks > kPatience) {
        break;
      }
      if (error < settings_.mse_limit) break;
    }
    if (std::isfinite(least)) s.at.weights = best;
  }

  const FitSettings& settings_;
  const FitProgress& progress_;
  const WhitenedSpace& space_;
  Random random_;
  std::vector<Sample> all_, train_, aside_;
  std::vector<CurvePoint> curve_;
  float noise_ = kFirstNoise;
  bool stopped_ = false;
};

std::optional<Error> invalid(std::span<const LabelledHand> hands,
                             const std::vector<std::string>& names, const FitSettings& s) {
  const auto error = [](std::string what) {
    return Error{Errc::kInvalidArgument, std::move(what)};
  };
  if (s.phi == Phi::kSignum)
    return error("phi signum has no slope and cannot be trained; allowed: sigmoid, atan");
  if (!(s.mse_limit >= 0))
    return error(fmt::format("mse_limit {}; it must be at least 0", s.mse_limit));
  if (s.starts < 1 || s.passes < 1)
    return error(fmt::format("{} starts, {} passes; each must be at least 1", s.starts, s.passes));
  if (!(s.validation_share >= 0 && s.validation_share <= 0.5))
    return error(fmt::format("validation share {}; allowed: 0 to 0.5", s.validation_share));
  if (names.size() < 2 || names.size() > kCodes)
    return error(fmt::format(
        "the hands show {} posture{}; needed are 2 to {}, one for each code of five bits: {}",
        names.size(), names.size() == 1 ? "" : "s", kCodes,
        names.size() < 2 ? "record hands of other postures too" : "leave some out"));
  for (std::size_t n = 0; n < hands.size(); ++n) {
    for (std::size_t i = 0; i < kInputs; ++i) {
      if (std::isfinite(hands[n].value[i])) continue;
      return error(fmt::format("hand {}: the value of {} is {}; allowed: a finite number", n,
                               kInputNames[i], hands[n].value[i]));
    }
  }
  return std::nullopt;
}

// Sets the last hands of each posture aside for validation. If they were chosen at random, their
// neighbours in the recording, which are nearly equal, would be among the training hands.
std::vector<bool> setAside(const std::vector<std::size_t>& posture, std::size_t postures,
                           double share) {
  std::vector<std::size_t> all(postures, 0), seen(postures, 0);
  for (const std::size_t p : posture) ++all[p];
  std::vector<bool> aside(posture.size());
  for (std::size_t n = 0; n < posture.size(); ++n) {
    const std::size_t p = posture[n];
    const auto kept = static_cast<std::size_t>(share * static_cast<double>(all[p]));
    aside[n] = ++seen[p] > all[p] - kept;
  }
  return aside;
}

double shareRight(const PostureNetwork& network, std::span<const LabelledHand> hands,
                  const std::vector<bool>& aside, bool which) {
  DataSet part;
  for (std::size_t n = 0; n < hands.size(); ++n) {
    if (aside[n] == which) part.push_back(hands[n]);
  }
  return score(network, part).accuracy();
}

}  // namespace

std::vector<std::string> posturesOf(std::span<const LabelledHand> hands,
                                    std::vector<std::size_t>& posture) {
  std::vector<std::string> names;
  posture.clear();
  for (const LabelledHand& hand : hands) {
    const auto at = std::find(names.begin(), names.end(), hand.posture);
    posture.push_back(static_cast<std::size_t>(at - names.begin()));
    if (at == names.end()) names.push_back(hand.posture);
  }
  return names;
}

Result<Fitted> fit(std::span<const LabelledHand> hands, const FitSettings& settings,
                   const FitProgress& progress) {
  std::vector<std::size_t> posture;
  const auto names = posturesOf(hands, posture);
  if (auto error = invalid(hands, names, settings)) return *std::move(error);
  Fitted done;
  Slots used{};
  done.network.phi = settings.phi;
  done.network.unit = settings.unit;
  done.network.ranges = rangesOf(hands, kGloveRanges, used);
  if (std::count(used.begin(), used.end(), true) == 0)
    return Error{
        Errc::kInvalidArgument,
        "the values of all sensors are constant; record hands that show different postures"};
  std::vector<Input> x;
  for (const LabelledHand& hand : hands) x.push_back(normalise(done.network.ranges, hand.value));
  done.statistics = statisticsOf(x, posture, names, used);
  const WhitenedSpace space(done.statistics, used);
  std::vector<Sample> samples;
  for (std::size_t n = 0; n < x.size(); ++n)
    samples.push_back({space.toSpace(x[n]), static_cast<std::uint32_t>(posture[n])});
  const auto aside = setAside(posture, names.size(), settings.validation_share);

  Fit work(settings, progress, space);
  work.take(std::move(samples), aside);
  const Start best = work.run();
  done.network.weights = space.fold(best.at.weights);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto added = done.network.postures.add(best.codes[k], names[k]);
    if (!added) return added.error();
  }
  done.curve = work.takeCurve();
  done.training_accuracy = shareRight(done.network, hands, aside, false);
  done.validation_accuracy = shareRight(done.network, hands, aside, true);
  done.trained = {fmt::format("back-propagation, {} passes over {} hands of {} postures",
                              done.curve.size(), hands.size(), names.size()),
                  settings.seed, hands.size(), best.error, false};
  return done;
}

}  // namespace merlin::nn
