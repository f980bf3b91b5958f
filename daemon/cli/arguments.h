// Command-line options: a small wrapper around CLI11. The header of CLI11 adds ten seconds to the
// compilation of each file that includes it, so only arguments.cpp includes it.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace merlin::cli {

// Handle of an option, a flag or a positional argument; valid as long as the CLI::App. The setters
// return the same handle, for chaining.
class Argument {
 public:
  explicit Argument(CLI::Option* option) : option_(option) {}

  Argument required();
  Argument typeName(const std::string& name);  // placeholder for the value in the help
  Argument expected(int values);               // exact number of values
  Argument expected(int least, int most);      // minimum and maximum number of values
  Argument repeatable();                       // may be given several times, with one value each
  Argument separated(char by);  // one argument may have several values, separated by `by`
  Argument showDefault();       // the help shows the variable's value as the default

  Argument range(int low, int high);
  Argument range(double low, double high);
  Argument range(std::size_t low, std::size_t high);
  Argument positive();
  Argument nonNegative();
  Argument seconds();  // a duration: 0.1 to 10 million
  Argument baud();     // a standard speed of serial lines, in bits per second
  Argument oneOf(std::vector<std::string> values);
  Argument size();  // number of bytes, also with a suffix: 900M, 16G (powers of 1024)
  // Adds a check of each value: `fault` returns a message, or an empty string for a valid value.
  Argument check(std::function<std::string(const std::string&)> fault);

  // Returns whether the command line contains the option; valid after parsing.
  bool isGiven() const;

 private:
  friend class Command;
  CLI::Option* option_;
};

// Handle of a command, a subcommand or a group of options; valid as long as the CLI::App.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  Command subcommand(const std::string& name, const std::string& help);
  void requireSubcommand();  // exactly one subcommand must be given
  Command group(const std::string& name, const std::string& help);
  void atMostOne();  // at most one of the group's options may be given

  // Adds an option that is parsed into `value`, which must outlive the parsing. `names`:
  // "-o,--output" for an option, "name" for a positional argument. T: int, unsigned, std::int64_t,
  // std::uint64_t, float, double, std::string; also std::optional and std::vector of some of these
  // types.
  template <typename T>
  Argument option(const std::string& names, T& value, const std::string& help = "");
  // Adds a flag that sets `value` to true; or to false if `names` starts with "!", as in "!--name".
  Argument flag(const std::string& names, bool& value, const std::string& help = "");

  // Sets a function that is called after parsing if this command was given.
  void callback(const std::function<void()>& chosen);

  void exclude(const Argument& other);  // this command or group cannot be combined with `other`

 private:
  CLI::App* app_;
};

// Reports that the command line lacks the option `what`, by throwing CLI::RequiredError. To be
// called only in a callback of Command::callback(), whose caller catches the exception.
[[noreturn]] void lacks(const std::string& what);

}  // namespace merlin::cli
