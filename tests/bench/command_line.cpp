#include "tests/bench/command_line.h"

#include <CLI/CLI.hpp>

namespace merlin::bench {

CommandLine::CommandLine(const std::string& about) : app_(std::make_unique<CLI::App>(about)) {}
CommandLine::~CommandLine() = default;

cli::Command CommandLine::command() { return cli::Command(*app_); }

std::optional<int> CommandLine::parse(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& e) {
    return app_->exit(e);
  }
}

int CommandLine::run(const std::string& name, int argc, char** argv,
                     const std::function<bool(Report&)>& measure) {
  bool json = false;
  flag("--json", json, "The figures as one JSON object");
  if (const auto status = parse(argc, argv)) return *status;
  return runBench(name, json, measure);
}

}  // namespace merlin::bench
