// What a program's command line says of itself: commands, options, help. From it come the manual
// page and the completion of a shell, so that they say what --help says.
#pragma once

#include <string>
#include <vector>

namespace merlin::manual {

struct ProgramOption {
  std::vector<std::string> names{};    // "-o", "--output"; of a positional argument: "file"
  std::string value{};                 // placeholder of its value, "FILE"; empty: a flag
  std::string range{};                 // which values, in words of the help; empty: any
  std::vector<std::string> choices{};  // the only values, if there are such
  std::string default_value{};         // as the help shows it; empty: none
  std::string help{};
  bool required = false;
  bool repeats = false;  // takes several values
};

struct ProgramCommand {
  std::string name{};
  std::string help{};  // lines; "Example: ..." is a line of its own
  std::vector<ProgramOption> options{}, positionals{};
  std::vector<ProgramCommand> commands{};
};

// What a manual page has beside the command line.
struct PageSettings {
  std::string name{};     // of the program
  std::string summary{};  // a few words without a full stop: what it is
  int section = 1;        // of the manual: 1 commands, 8 daemons
  struct File {
    std::string path{}, what{};
  };
  std::vector<File> files{};
  std::vector<std::string> see_also{};  // "merlind(8)"
};

}  // namespace merlin::manual
