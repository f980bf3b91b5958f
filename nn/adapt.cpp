#include "nn/adapt.h"

#include <algorithm>
#include <cmath>

#include "nn/descent.h"

namespace merlin::nn {
namespace {

constexpr std::size_t kPasses = 120;
constexpr float kRate = 0.004F;
constexpr float kNoise = 0.5F;           // noise added to each hand, in standard deviations
constexpr std::size_t kRehearsed = 100;  // number of hands drawn for each posture
// Spread of the drawn hands, in standard deviations of the statistics; above 1, since other people
// differ more than those in the statistics.
constexpr float kRehearsedNoise = 1.15F;
// Greatest decrease of the recognised share of drawn hands.
constexpr double kMostForgotten = 0.005;
// Recognised share of new hands at which no larger change of the weights is tried.
constexpr double kEnough = 0.999;
// The fractions of the trained change of the weights that are tried.
constexpr double kShares[] = {0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1};

Slots usedBy(const Weights& weights) {
  Slots used{};
  for (const auto& row : weights.hidden) {
    for (std::size_t i = 0; i < kInputs; ++i) used[i] = used[i] || row[i] != 0;
  }
  return used;
}

// Draws `each` hands of every posture, in whitened coordinates. They resemble the hands on which
// the network was trained.
std::vector<Sample> rehearse(const WhitenedSpace& space, std::size_t each, Random& random) {
  std::vector<Sample> samples;
  for (std::size_t k = 0; k < space.means().size(); ++k) {
    for (std::size_t n = 0; n < each; ++n) {
      Sample s{space.means()[k], static_cast<std::uint32_t>(k)};
      for (float& u : s.u) {
        double bell = -2;
        for (int i = 0; i < 4; ++i) bell += random.uniform();
        u += kRehearsedNoise * space.sigma() * static_cast<float>(1.7320508075688772 * bell);
      }
      samples.push_back(s);
    }
  }
  return samples;
}

double shareRight(Phi phi, const PackedWeights<float>& weights, std::span<const Sample> samples,
                  std::span<const std::uint32_t> codes) {
  std::size_t right = 0;
  PackedPass<float> pass;
  for (const Sample& s : samples) {
    propagate(phi, weights, s.u.data(), pass);
    Output output;
    std::copy_n(pass.output.begin(), kOutputs, output.begin());
    right += threshold(output) == codes[s.posture] ? 1U : 0U;
  }
  return static_cast<double>(right) / static_cast<double>(std::max<std::size_t>(samples.size(), 1));
}

PackedWeights<float> between(const PackedWeights<float>& from, const PackedWeights<float>& to,
                             double share) {
  PackedWeights<float> mixed = from;
  for (std::size_t i = 0; i < mixed.all.size(); ++i)
    mixed.all[i] += static_cast<float>(share) * (to.all[i] - from.all[i]);
  return mixed;
}

Error unknown(const std::string& posture, const PostureStatistics& statistics) {
  std::string names;
  for (const std::string& name : statistics.postures) names += names.empty() ? name : ", " + name;
  return {Errc::kInvalidArgument, "posture \"" + posture +
                                      "\" is not one of the network's, which are " + names +
                                      "; a new posture needs a new training"};
}

Result<std::vector<Sample>> toSamples(std::span<const LabelledHand> hands,
                                      const PostureStatistics& statistics,
                                      const PostureNetwork& network, const WhitenedSpace& space) {
  std::vector<Sample> samples;
  for (const LabelledHand& hand : hands) {
    const auto at = std::find(statistics.postures.begin(), statistics.postures.end(), hand.posture);
    if (at == statistics.postures.end()) return unknown(hand.posture, statistics);
    if (!std::all_of(hand.value.begin(), hand.value.end(),
                     [](float v) { return std::isfinite(v); }))
      return Error{Errc::kInvalidArgument, "a hand with a value that is not finite"};
    samples.push_back({space.toSpace(normalise(network.ranges, hand.value)),
                       static_cast<std::uint32_t>(at - statistics.postures.begin())});
  }
  return samples;
}

}  // namespace

Result<Adapted> adapt(const PostureNetwork& network, const PostureStatistics& statistics,
                      std::span<const LabelledHand> hands, std::uint64_t seed) {
  if (hands.empty()) return Error{Errc::kInvalidArgument, "no hands to adapt to"};
  const WhitenedSpace space(statistics, usedBy(network.weights));
  const auto samples = toSamples(hands, statistics, network, space);
  if (!samples) return samples.error();
  std::vector<std::uint32_t> codes;
  for (const std::string& name : statistics.postures)
    codes.push_back(network.postures.code(name).value_or(0));

  Random random(seed);
  const auto known = rehearse(space, kRehearsed, random);
  std::vector<Sample> both = known;
  for (std::size_t n = 0; n < known.size() / 2; ++n)  // two drawn hands for each new one
    both.push_back((*samples)[random.below(samples->size())]);
  const PackedWeights<float> before = space.unfold(network.weights);
  Descending at;
  at.weights = before;
  Descent descent(network.phi, both, space.means(), Random(random.next()));
  const float noise = kNoise * space.sigma();
  for (std::size_t i = 0; i < kPasses; ++i) {
    const float left = 1 - static_cast<float>(i) / kPasses;
    descent.pass(at, codes, kRate * left, {noise, 1, noise, 1});
  }

  const auto held_out = rehearse(space, kRehearsed, random);
  Adapted done;
  done.drawn_before = shareRight(network.phi, before, held_out, codes);
  done.hands_before = shareRight(network.phi, before, *samples, codes);
  for (const double share : kShares) {
    const PackedWeights<float> weights = between(before, at.weights, share);
    const double drawn_after = shareRight(network.phi, weights, held_out, codes);
    if (share > 0 && drawn_after < done.drawn_before - kMostForgotten) break;
    done.share = share;
    done.drawn_after = drawn_after;
    done.hands_after = shareRight(network.phi, weights, *samples, codes);
    done.network = network;
    if (share > 0) done.network.weights = space.fold(weights);
    if (done.hands_after >= kEnough) break;
  }
  return done;
}

}  // namespace merlin::nn
