// The import of models for `merlin mesh import` and `merlin show`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/cli/command.h"
#include "daemon/cli/mesh/import_points.h"
#include "daemon/cli/mesh/import_range.h"
#include "daemon/cli/progress.h"

namespace merlin::cli {

struct MeshImport {
  std::vector<std::string> inputs;  // the input file; always one entry
  std::string output, texture;
  RangeImport range;
  PointImport points;
  std::uint64_t memory = 0;  // limit in bytes; 0: the free memory
  unsigned threads = 0;      // 0: all cores
  bool local = false;        // whether a mesh is written without adding its origin
  bool json = false;
  bool quiet = false;           // no report; notes and progress are still printed
  ProgressListener progress{};  // may be empty
  bool outwards = false;        // whether closed parts that face inwards are turned outwards

  const std::string& input() const { return inputs.front(); }
};

// Adds the options about the input, and --memory and --threads.
void addImportOptions(Command command, MeshImport& options);

// Imports the file; prints notes, progress and the report. Ctrl-C leaves no files behind. Errors:
// those of the readers, of the reduction and of the writers, with the file's name.
Result<Ok> importFile(MeshImport& options);

}  // namespace merlin::cli
