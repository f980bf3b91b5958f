#include "tests/bench/figures.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <thread>

namespace merlin::bench {
namespace {

#ifdef NDEBUG
constexpr const char* kBuild = "without assertions";
#else
constexpr const char* kBuild = "with assertions";
#endif

}  // namespace

void didNotRun(std::string_view subject, std::string_view found, std::string_view way_out) {
  throw DidNotRun(fmt::format("{}: {}; {}", subject, found, way_out));
}

Measured Measured::of(double value, std::uint64_t count, std::string_view what) {
  if (count == 0) throw DidNotRun(fmt::format("no {} were measured", what));
  if (!std::isfinite(value))
    throw DidNotRun(fmt::format("{}: {} of {} measurements is no figure", what, value, count));
  return {value, count};
}

Measured shareOf(std::uint64_t part, std::uint64_t whole, std::string_view what) {
  return Measured::of(static_cast<double>(part) / static_cast<double>(whole), whole, what);
}

Measured quantileOf(const std::vector<double>& values, double share, std::string_view what) {
  if (values.empty()) return Measured::of(0, 0, what);  // throws, since the count is 0
  std::vector<double> sorted = values;
  const auto at = static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(at), sorted.end());
  return Measured::of(sorted[at], sorted.size(), what);
}

Measured medianOf(const std::vector<double>& values, std::string_view what) {
  return quantileOf(values, 0.5, what);
}

Measured meanOf(const std::vector<double>& values, std::string_view what) {
  double sum = 0;
  for (const double value : values) sum += value;
  return Measured::of(sum / static_cast<double>(values.size()), values.size(), what);
}

Measured ratioOf(const Measured& over, const Measured& under, std::string_view what) {
  return Measured::of(over / under, std::min(over.count(), under.count()), what);
}

Measured scaled(const Measured& measured, double factor) {
  return Measured::of(factor * measured, measured.count(), "measurements");
}

// Uses the same method as soak/measures.py; both pass the same tests.
Slope slopeOf(const std::vector<std::pair<double, double>>& points, std::string_view what) {
  if (points.size() < 10)
    throw DidNotRun(fmt::format("{} {} are too few for a slope", points.size(), what));
  const auto n = static_cast<double>(points.size());
  double mx = 0, my = 0, sxx = 0, sxy = 0;
  for (const auto& [x, y] : points) {
    mx += x / n;
    my += y / n;
  }
  for (const auto& [x, y] : points) {
    sxx += (x - mx) * (x - mx);
    sxy += (x - mx) * (y - my);
  }
  const double slope = sxy / sxx;
  double square = 0, product = 0, last = 0;
  for (const auto& [x, y] : points) {
    const double residual = y - my - slope * (x - mx);
    square += residual * residual;
    product += residual * last;
    last = residual;
  }
  const double alike = square > 0 ? std::clamp(product / square, 0.0, 0.999) : 0;
  const double degrees = std::max(n * (1 - alike) / (1 + alike) - 2, 1.0);
  constexpr double kNormal = 1.96;
  // quantile of Student's t distribution, accurate to 3 % from 3 degrees of freedom on
  const double t =
      kNormal * (1 + (kNormal * kNormal + 1) / (4 * degrees) + 2.5 / (degrees * degrees));
  return {Measured::of(slope, points.size(), what),
          Measured::of(t * std::sqrt(square / degrees / sxx), points.size(), what)};
}

void Report::figure(const std::string& name, const Measured& measured, const std::string& unit) {
  assert(!figures_.contains(name));
  figures_[name] = {{"value", measured.value()}, {"unit", unit}, {"count", measured.count()}};
}

void Report::figure(const std::string& name, const std::string& value, std::uint64_t count) {
  assert(!figures_.contains(name));
  if (count == 0) throw DidNotRun(fmt::format("no {} were measured", name));
  figures_[name] = {{"value", value}, {"count", count}};
}

void Report::print(bool json) const {
  if (figures_.empty()) throw DidNotRun("it measured nothing");
  const nlohmann::ordered_json object = {
      {"bench", bench_},
      {"machine", {{"cores", std::thread::hardware_concurrency()}, {"build", kBuild}}},
      {"figures", figures_}};
  fmt::print("{}", json ? object.dump() + "\n" : text_);
  if (std::fflush(stdout) != 0) throw DidNotRun("standard output cannot be written");
}

void note(std::string_view what) {
  fmt::print(stderr, "{}\n", what);
  std::fflush(stderr);
}

int runBench(const std::string& bench, bool json, const std::function<bool(Report&)>& measure) {
  // After an unexpected exception (an invalid configuration, a folder that cannot be made), no
  // figure must be printed either.
  try {
    Report report(bench);
    const bool kept = measure(report);
    report.print(json);
    return kept ? 0 : 1;
  } catch (const std::exception& e) {
    note(fmt::format("bench {}: no figures: {}", bench, e.what()));
    return 1;
  }
}

}  // namespace merlin::bench
