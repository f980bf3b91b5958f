// What every benchmark prints, for people and for programs (--json), and the rule that one whose
// subject did not run fails and prints no figure.
//
// A figure is made of measurements, of which there has to be at least one: Measured has no other
// way to be made. Where there is none, where a subject does not start or ends early, DidNotRun ends
// the benchmark. So nothing goes to standard output before everything was measured; what a long
// benchmark is doing goes to standard error (note).
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

// The message that the benchmark ends with.
struct DidNotRun : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Throws DidNotRun with "subject: found; way_out": which subject (a program, a file) does not run
// or is not there, what was found instead, and the way out.
[[noreturn]] void didNotRun(std::string_view subject, std::string_view found,
                            std::string_view way_out);

// A finite number that was made of `count` measurements, at least one. The functions below throw
// DidNotRun where there is none; `what` names what was measured: "frames of the wall".
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

// part / whole, of `whole` things that were counted.
Measured shareOf(std::uint64_t part, std::uint64_t whole, std::string_view what);

// The value that `share` of the others are no larger than.
Measured quantileOf(const std::vector<double>& values, double share, std::string_view what);
Measured medianOf(const std::vector<double>& values, std::string_view what);
Measured meanOf(const std::vector<double>& values, std::string_view what);

// Throws DidNotRun also where `under` is zero: then what the ratio is of did not run.
Measured ratioOf(const Measured& over, const Measured& under, std::string_view what);

// A measured value in another unit.
Measured scaled(const Measured& measured, double factor);

// The measurements so far, held back until all are done. Thread-bound.
class Report {
 public:
  explicit Report(std::string bench) : bench_(std::move(bench)) {}

  // For people: a part of the table.
  template <typename... T>
  void text(fmt::format_string<T...> format, T&&... arguments) {
    text_ += fmt::format(format, std::forward<T>(arguments)...);
  }

  // For programs. A name is there once; `unit` is a unit's symbol ("ms", "Hz"), "1" for a pure
  // number.
  void figure(const std::string& name, const Measured& measured, const std::string& unit);
  // A figure that is no number (a hash), made of `count` measurements.
  void figure(const std::string& name, const std::string& value, std::uint64_t count);

  // Prints the text, or one JSON object {bench, machine, figures}. Throws DidNotRun where there is
  // no figure, and where standard output cannot be written.
  void print(bool json) const;

 private:
  std::string bench_, text_;
  nlohmann::ordered_json figures_ = nlohmann::ordered_json::object();
};

// Says at once, on standard error, what a benchmark is doing: no figures.
void note(std::string_view what);

// The whole of a benchmark's main() after its options were read. `measure` says whether what
// was measured is what is promised. Returns the exit status: 0; 1 where it is not, and, with a
// message and without a figure, where a subject did not run.
int runBench(const std::string& bench, bool json, const std::function<bool(Report&)>& measure);

}  // namespace merlin::bench
