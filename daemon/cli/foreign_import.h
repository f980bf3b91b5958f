// Runs the program merlin-import on a file in another program's format, and passes its result on.
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

// What merlin-import is to read, and its limits.
struct ForeignFile {
  std::string kind;   // first argument of merlin-import
  std::string input;  // the file to read
  // Output file of the command; the temporary work folder is made beside it.
  std::string output;
  std::vector<std::string> options;  // further arguments of merlin-import
  std::uint64_t memory_bytes = 0;    // memory limit of merlin-import
  // Limit of CPU time: 60 s, and one second for each `bytes_per_second` bytes of the input. Most
  // libraries need a tenth of that or less.
  std::uint64_t bytes_per_second = 100'000;
};

// The report of merlin-import. Nothing in it can be trusted, because it comes from a process that
// has read a possibly hostile file.
struct ForeignReport {
  nlohmann::json facts;            // a JSON object
  std::vector<std::string> notes;  // for the user, also about what the system lacks for the sandbox

  // Returns the fact `key` as a number of items; nothing if it is missing or not an unsigned
  // integer.
  std::optional<std::size_t> count(const char* key) const;
  // Returns the fact `key`; 0 if it is missing or not a number.
  double number(const char* key) const;
  // Returns the fact `key` as one line of text; empty if it is missing or not a text.
  std::string text(const char* key) const;
};

// Runs merlin-import, shows its progress from the third second on, and calls `take` with the path
// of the result, which is a regular file in a temporary folder; then removes that folder. Ctrl-C
// ends the import and leaves no files behind. Errors, with the input's name: those of the import,
// of ImportChild::follow() and of `take`.
Result<ForeignReport> importForeign(const ForeignFile& file,
                                    const std::function<Result<Ok>(const std::string&)>& take);

// Returns how long an import of this many bytes may take without a report of progress before it is
// ended; a library may report none at all.
Duration patienceFor(std::uint64_t bytes, std::uint64_t bytes_per_second) noexcept;

}  // namespace merlin::cli
