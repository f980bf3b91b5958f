// Command-line options of a benchmark. The header of CLI11 adds seconds to the compilation of each
// file that includes it, so only command_line.cpp includes it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "daemon/cli/arguments.h"

namespace merlin::bench {

class CommandLine {
 public:
  explicit CommandLine(const std::string& about);  // what the benchmark measures, for its help
  ~CommandLine();

  // As of cli::Command.
  template <typename T>
  cli::Argument option(const std::string& names, T& value, const std::string& help = "") {
    return command().option(names, value, help);
  }
  cli::Argument flag(const std::string& names, bool& value, const std::string& help) {
    return command().flag(names, value, help);
  }

  // Returns nothing if the benchmark is to run. Otherwise, after --help or an invalid argument,
  // prints the text and returns the exit status.
  std::optional<int> parse(int argc, char** argv);

 private:
  cli::Command command();

  std::unique_ptr<CLI::App> app_;
};

}  // namespace merlin::bench
