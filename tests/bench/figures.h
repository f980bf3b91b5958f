// The output of every benchmark, for people and for programs (--json), and the rule that a
// benchmark whose subject did not run fails and prints no figure.
//
// A figure is made from at least one measurement, since a Measured cannot be made otherwise. If
// there is no measurement, or if a subject does not start or ends early, DidNotRun ends the
// benchmark. Nothing is therefore printed on standard output before everything has been measured; a
// long benchmark reports its progress on standard error (note()).
#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace merlin::bench {

// An exception that ends the benchmark with this message.
struct DidNotRun : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Throws DidNotRun with the text "subject: found; way_out". `subject`: the program or file that
// does not run or does not exist; `found`: what was found instead; `way_out`: what the user can do.
[[noreturn]] void didNotRun(std::string_view subject, std::string_view found,
                            std::string_view way_out);

// A finite number made from `count` measurements, at least one. The functions below throw DidNotRun
// if there are no measurements; `what` names the things measured, such as "frames of the wall".
class Measured {
 public:
  static Measured of(double value, std::uint64_t count, std::string_view what);

  double value() const { return value_; }
  operator double() const { return value_; }
  std::uint64_t count() const { return count_; }

 private:
  Measured(double value, std::uint64_t count) : value_(value), count_(count) {}
  double value_;
  std::uint64_t count_;
};

// Returns part / whole; `whole` is the number of things that were counted.
Measured shareOf(std::uint64_t part, std::uint64_t whole, std::string_view what);

// Returns the quantile of the values at `share`, 0..1.
Measured quantileOf(const std::vector<double>& values, double share, std::string_view what);
Measured medianOf(const std::vector<double>& values, std::string_view what);
Measured meanOf(const std::vector<double>& values, std::string_view what);

// Returns over / under. Throws DidNotRun also if `under` is zero, since its subject did not run
// then.
Measured ratioOf(const Measured& over, const Measured& under, std::string_view what);

// Returns the value multiplied by `factor`, for another unit; the count is unchanged.
Measured scaled(const Measured& measured, double factor);

// A slope by least squares, and half the width of its 95 % confidence interval.
struct Slope {
  Measured value, half_width;
};
// Returns the slope of points (x, y), which are in the order of x. Frequently sampled values, such
// as a process's memory, change in steps, so neighbouring residuals are correlated; the number of
// points that count as independent is reduced accordingly. Throws DidNotRun for fewer than ten
// points.
Slope slopeOf(const std::vector<std::pair<double, double>>& points, std::string_view what);

// The results so far, which are not printed before everything has been measured. Thread-bound.
class Report {
 public:
  explicit Report(std::string bench) : bench_(std::move(bench)) {}

  // Appends to the text for people.
  template <typename... T>
  void text(fmt::format_string<T...> format, T&&... arguments) {
    text_ += fmt::format(format, std::forward<T>(arguments)...);
  }

  // Adds a figure for programs. Each name may occur once; `unit` is a unit's symbol ("ms", "Hz"),
  // or "1" for a pure number.
  void figure(const std::string& name, const Measured& measured, const std::string& unit);
  // Adds a figure that is not a number (a hash), made from `count` measurements.
  void figure(const std::string& name, const std::string& value, std::uint64_t count);

  // Prints the text, or one JSON object {bench, machine, figures}. Throws DidNotRun if there is no
  // figure, or if standard output cannot be written.
  void print(bool json) const;

 private:
  std::string bench_, text_;
  nlohmann::ordered_json figures_ = nlohmann::ordered_json::object();
};

// Reports progress on standard error at once. Do not use it for figures.
void note(std::string_view what);

// Does everything that remains of a benchmark's main() after it has read its options. `measure`
// returns whether the figures are within their limits. Returns the exit status: 0 if they are; 1 if
// they are not, or, with a message and without figures, if a subject did not run.
int runBench(const std::string& bench, bool json, const std::function<bool(Report&)>& measure);

}  // namespace merlin::bench
