// Lets the program merlin-import read a file in another program's format, and takes its result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"

namespace merlin::cli {

struct ForeignFile {
  std::string kind;    // first argument of merlin-import
  std::string input;   // the file
  std::string output;  // output file of the command; the temporary work folder is beside it
  std::vector<std::string> options;  // further arguments of merlin-import
  std::uint64_t memory_bytes = 0;    // limit for merlin-import
  // One second of CPU time is allowed for this many bytes; most libraries take a tenth of that or
  // less.
  std::uint64_t bytes_per_second = 100'000;
};

// The report of merlin-import. Nothing in it can be trusted, since it comes from a process that
// read a possibly hostile file.
struct ForeignReport {
  nlohmann::json facts;            // an object
  std::vector<std::string> notes;  // for the user; also what the sandbox could not do

  std::optional<std::size_t> count(const char* key) const;  // nothing if there is none
  double number(const char* key) const;                     // else 0
  std::string text(const char* key) const;                  // one line; else empty
};

// Starts merlin-import, shows its progress from the third second on, and calls `take` with the path
// of the result, which is a regular file; afterwards removes it and everything beside it. Ctrl-C
// ends the import and leaves nothing. Errors, with the input's name: those of the import, of
// ImportChild::follow() and of `take`.
Result<ForeignReport> importForeign(const ForeignFile& file,
                                    const std::function<Result<Ok>(const std::string&)>& take);

// How long an import of this many bytes may show no progress, since a library may report none.
Duration patienceFor(std::uint64_t bytes, std::uint64_t bytes_per_second) noexcept;

}  // namespace merlin::cli
