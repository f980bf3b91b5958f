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

}  // namespace merlin::bench
