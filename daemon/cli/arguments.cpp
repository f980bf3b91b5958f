#include "daemon/cli/arguments.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <type_traits>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/base/printable_text.h"
#include "drivers/port/port_address.h"

namespace merlin::cli {

namespace {

// Returns a check like `validator` with our own message, '"abc" is not ' and `wanted`. CLI11's
// message would print the largest double with three hundred digits.
CLI::Validator worded(const CLI::Validator& validator, const std::string& wanted) {
  return CLI::Validator(
      [validator, wanted](std::string& value) {
        const std::string kept = value;
        bool valid = false;
        try {
          valid = validator(value).empty();
        } catch (const CLI::ValidationError&) {  // the value has an unknown unit
        }
        return valid ? std::string() : fmt::format("\"{}\" is not {}", excerpt(kept), wanted);
      },
      validator.get_description());
}

template <typename T>
CLI::Validator between(T low, T high, const char* what) {
  return worded(CLI::Range(low, high), fmt::format("{} from {} to {}", what, low, high));
}

}  // namespace

Argument Argument::required() { return Argument(option_->required()); }
Argument Argument::typeName(const std::string& name) { return Argument(option_->type_name(name)); }
Argument Argument::expected(int values) { return Argument(option_->expected(values)); }
Argument Argument::expected(int least, int most) {
  return Argument(option_->expected(least, most));
}
Argument Argument::repeatable() { return Argument(option_->allow_extra_args(false)); }
Argument Argument::separated(char by) { return Argument(option_->delimiter(by)); }
Argument Argument::showDefault() { return Argument(option_->capture_default_str()); }

Argument Argument::range(int low, int high) {
  return Argument(option_->check(between(low, high, "a whole number")));
}
Argument Argument::range(double low, double high) {
  return Argument(option_->check(between(low, high, "a number")));
}
Argument Argument::range(std::size_t low, std::size_t high) {
  return Argument(option_->check(between(low, high, "a whole number")));
}
Argument Argument::positive() {
  return Argument(option_->check(worded(CLI::PositiveNumber, "a number above 0")));
}
Argument Argument::nonNegative() {
  return Argument(option_->check(worded(CLI::NonNegativeNumber, "a number of 0 or more")));
}
Argument Argument::seconds() {
  return Argument(option_->type_name("SECONDS")->check(between(0.1, 1e7, "a number of seconds")));
}
Argument Argument::baud() {
  return Argument(
      option_->check(CLI::IsMember(std::vector<int>(lineSpeeds().begin(), lineSpeeds().end()))));
}
Argument Argument::oneOf(std::vector<std::string> values) {
  const std::string wanted = fmt::format("one of {}", fmt::join(values, ", "));
  return Argument(option_->check(worded(CLI::IsMember(std::move(values)), wanted)));
}
Argument Argument::size() {
  return Argument(option_->transform(
      worded(CLI::AsSizeValue(false), "a number of bytes, such as 900M or 16G")));
}
Argument Argument::check(std::function<std::string(const std::string&)> fault) {
  return Argument(option_->check(CLI::Validator(
      [fault = std::move(fault)](const std::string& value) { return fault(value); }, "")));
}
bool Argument::isGiven() const { return option_->count() > 0; }

Command Command::subcommand(const std::string& name, const std::string& help) {
  return Command(*app_->add_subcommand(name, help));
}
void Command::requireSubcommand() { app_->require_subcommand(1); }
Command Command::group(const std::string& name, const std::string& help) {
  return Command(*app_->add_option_group(name, help));
}
void Command::atMostOne() { app_->require_option(0, 1); }
void Command::callback(const std::function<void()>& chosen) { app_->callback(chosen); }
void Command::exclude(const Argument& other) { app_->excludes(other.option_); }

Argument Command::flag(const std::string& names, bool& value, const std::string& help) {
  return Argument(app_->add_flag(names, value, help));
}

namespace {

template <typename T>
struct Plain {
  using type = T;
};
template <typename T>
struct Plain<std::optional<T>> {
  using type = T;
};
template <typename T>
struct Plain<std::vector<T>> {
  using type = T;
};

// Returns the fault of a value that CLI11 would accept wrongly: a negative number for an unsigned
// type (it would wrap around to a large one), "nan" and "inf" for a floating-point type. Returns an
// empty text for a valid value.
template <typename T>
std::string faultOf(const std::string& value) {
  if (std::is_unsigned_v<T> && value.starts_with('-')) return value + " is less than 0";
  if (std::is_floating_point_v<T> && !std::isfinite(std::strtod(value.c_str(), nullptr)))
    return value + " is not a finite number";
  return {};
}

}  // namespace

template <typename T>
Argument Command::option(const std::string& names, T& value, const std::string& help) {
  Argument argument(app_->add_option(names, value, help));
  using Number = typename Plain<T>::type;
  return std::is_arithmetic_v<Number> ? argument.check(faultOf<Number>) : argument;
}
template Argument Command::option(const std::string&, int&, const std::string&);
template Argument Command::option(const std::string&, unsigned&, const std::string&);
template Argument Command::option(const std::string&, std::int64_t&, const std::string&);
template Argument Command::option(const std::string&, std::uint64_t&, const std::string&);
template Argument Command::option(const std::string&, float&, const std::string&);
template Argument Command::option(const std::string&, double&, const std::string&);
template Argument Command::option(const std::string&, std::string&, const std::string&);
template Argument Command::option(const std::string&, std::vector<std::string>&,
                                  const std::string&);
template Argument Command::option(const std::string&, std::vector<int>&, const std::string&);
template Argument Command::option(const std::string&, std::vector<double>&, const std::string&);
template Argument Command::option(const std::string&, std::optional<std::size_t>&,
                                  const std::string&);
template Argument Command::option(const std::string&, std::optional<double>&, const std::string&);

void lacks(const std::string& what) { throw CLI::RequiredError(what); }

}  // namespace merlin::cli
