// Parses the arguments of a program with CLI11, whose exceptions end here.
#pragma once

#include <optional>
#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "daemon/base/log.h"
#include "daemon/base/printable_text.h"
#include "daemon/cli/exit_status.h"

namespace merlin {

// Returns nothing if the program is to run. Otherwise, after --help, --version or an invalid
// argument, prints the text and returns the exit status.
inline std::optional<int> parseArguments(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& e) {
    std::ostringstream help, why;
    const int status = app.exit(e, help, why);
    fmt::print("{}", help.str());
    printError("{}", printable(why.str()));
    return status == 0 ? kExitDone : kExitBadInput;
  }
}

}  // namespace merlin
