// Command-line options of a benchmark. The header of CLI11 adds seconds to the compilation of each
// file that includes it, so only command_line.cpp includes it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "daemon/cli/arguments.h"
#include "tests/bench/figures.h"

namespace merlin::bench {

class CommandLine {
 public:
  // `about`: what the benchmark measures, for its help text
  explicit CommandLine(const std::string& about);
  ~CommandLine();

  // Adds an option or a flag; same arguments as cli::Command::option().
  template <typename T>
  cli::Argument option(const std::string& names, T& value, const std::string& help = "") {
    return command().option(names, value, help);
  }
  cli::Argument flag(const std::string& names, bool& value, const std::string& help) {
    return command().flag(names, value, help);
  }

  // Returns nothing if the benchmark is to run. After --help or an invalid argument, prints the
  // text for it and returns the exit status.
  std::optional<int> parse(int argc, char** argv);

  // Adds --json, parses the options, and runs the benchmark `name` with runBench(); returns the
  // exit status.
  int run(const std::string& name, int argc, char** argv,
          const std::function<bool(Report&)>& measure);

 private:
  cli::Command command();

  std::unique_ptr<CLI::App> app_;
};

}  // namespace merlin::bench
