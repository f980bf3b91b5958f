// Command-line options: a small wrapper around CLI11. Its header adds ten seconds to each file that
// includes it, so only arguments.cpp does.
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

// A handle of an option, a flag or a positional argument; valid as long as its command.
class Argument {
 public:
  explicit Argument(CLI::Option* option) : option_(option) {}

  Argument required();
  Argument typeName(const std::string& name);  // placeholder for the value in the help
  Argument expected(int values);               // number of values, exactly
  Argument separated(char by);                 // several values in one word, separated by `by`
  Argument showDefault();                      // the help shows the variable's current value

  Argument range(int low, int high);
  Argument range(double low, double high);
  Argument range(std::size_t low, std::size_t high);
  Argument positive();
  Argument nonNegative();
  Argument seconds();  // a duration: 0.1 to 10 million
  Argument baud();     // a standard speed of serial lines
  Argument oneOf(std::vector<std::string> values);
  Argument size();  // bytes with a suffix, 900M or 16G; powers of 1000
  // `fault` returns what is wrong with a value, or an empty string.
  Argument check(std::function<std::string(const std::string&)> fault);

  bool isGiven() const;  // after parsing

 private:
  friend class Command;
  CLI::Option* option_;
};

// A handle of a command, a subcommand or a group of options; valid as long as the CLI::App.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  Command subcommand(const std::string& name, const std::string& help);
  void requireSubcommand();  // exactly one
  Command group(const std::string& name, const std::string& help);
  void atMostOne();  // at most one of the group's options may be given

  // "-o,--output": an option; "name": a positional argument. T: int, unsigned, std::int64_t,
  // std::uint64_t, float, double, std::string, and std::optional and std::vector of some of them.
  template <typename T>
  Argument option(const std::string& names, T& value, const std::string& help = "");
  // With names "!--name", giving the flag sets `value` to false.
  Argument flag(const std::string& names, bool& value, const std::string& help = "");

  // Called after parsing if this command was chosen.
  void callback(const std::function<void()>& chosen);

  void exclude(const Argument& other);  // neither this command nor its options with `other`

 private:
  CLI::App* app_;
};

// To be called by a callback if the command line lacks `what`: throws the parser's error.
[[noreturn]] void lacks(const std::string& what);

}  // namespace merlin::cli
