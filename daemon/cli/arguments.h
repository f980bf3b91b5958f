// Arguments: what a command line may say. CLI11 behind a few names: its header takes ten seconds of
// every file that includes it, so one does.
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

// An option, a flag or a positional argument; a handle, good as long as its command is.
class Argument {
 public:
  explicit Argument(CLI::Option* option) : option_(option) {}

  Argument required();
  Argument typeName(const std::string& name);  // what stands for the value in the help
  Argument expected(int values);               // exactly so many
  Argument separated(char by);                 // several values in one word
  Argument showDefault();                      // in the help, the value that the variable has now

  Argument range(int low, int high);
  Argument range(double low, double high);
  Argument range(std::size_t low, std::size_t high);
  Argument positive();
  Argument nonNegative();
  Argument seconds();  // a duration: 0.1 to 10 million
  Argument baud();     // a speed that serial lines have
  Argument oneOf(std::vector<std::string> values);
  Argument size();  // 900M, 16G: 1000 to the step
  // Empty, or what is wrong with a value.
  Argument check(std::function<std::string(const std::string&)> fault);

  bool isGiven() const;  // after parsing

 private:
  friend class Command;
  CLI::Option* option_;
};

// A command, a subcommand or a group of options; a handle, good as long as its program's is.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  Command subcommand(const std::string& name, const std::string& help);
  void requireSubcommand();  // one
  Command group(const std::string& name, const std::string& help);
  void atMostOne();  // of a group's options

  // "-o,--output": an option; "name": a positional. T: int, unsigned, std::int64_t, std::uint64_t,
  // float, double, std::string, std::optional and std::vector of some.
  template <typename T>
  Argument option(const std::string& names, T& value, const std::string& help = "");
  // "!--name": it is false when given.
  Argument flag(const std::string& names, bool& value, const std::string& help = "");

  // Called after parsing where the command is the one that was chosen.
  void callback(const std::function<void()>& chosen);

  void exclude(const Argument& other);  // by a group, all of it

 private:
  CLI::App* app_;
};

// Of a callback: the command line lacks this. Does not return.
[[noreturn]] void lacks(const std::string& what);

}  // namespace merlin::cli
