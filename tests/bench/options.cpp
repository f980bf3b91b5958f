#include "tests/bench/options.h"

#include <CLI/CLI.hpp>

namespace merlin::bench {

Options::Options(const std::string& about) : app_(std::make_unique<CLI::App>(about)) {}
Options::~Options() = default;

cli::Command Options::command() { return cli::Command(*app_); }

std::optional<int> Options::parse(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& e) {
    return app_->exit(e);
  }
}

}  // namespace merlin::bench
