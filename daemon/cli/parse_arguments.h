// Parses the arguments of a program with CLI11, catches its exceptions, and adds the options that
// print the manual page and the shell completion.
#pragma once

#include <optional>
#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "daemon/base/log.h"
#include "daemon/base/version.h"
#include "daemon/cli/argument_faults.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/program_of.h"
#include "daemon/manual/bash_completion.h"
#include "daemon/manual/man_page.h"

namespace merlin {

// Adds --print-manual and --print-completion. `page`: settings of the manual page; must outlive the
// parsing.
inline void addManualOptions(CLI::App& app, const manual::PageSettings& page) {
  app.add_flag_callback(
      "--print-manual",
      [&] {
        const std::string text = manPage(cli::programOf(app), page, programVersion());
        throw CLI::CallForVersion(text, 0);  // handled like --version: the text is printed
      },
      "Print this program's manual page, for man -l -, and exit");
  app.add_flag_callback(
      "--print-completion",
      [&] { throw CLI::CallForVersion(bashCompletion(cli::programOf(app), page.name), 0); },
      "Print completion of commands and options for bash, and exit");
}

// Parses the command line. Returns nothing if the program is to go on. After --help, --version,
// --print-manual, --print-completion or an invalid argument, prints the text or the fault and
// returns the exit status.
inline std::optional<int> parseArguments(CLI::App& app, int argc, char** argv,
                                         const manual::PageSettings& page) {
  addManualOptions(app, page);
  try {
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& e) {
    std::ostringstream help, ignored;
    if (app.exit(e, help, ignored) != 0) {
      printError("{}", cli::argumentFault(app, page.name, e));
      return kExitBadInput;
    }
    fmt::print("{}", help.str());
    return kExitDone;
  }
}

}  // namespace merlin
