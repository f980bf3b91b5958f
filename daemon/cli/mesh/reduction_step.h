// The step from a mesh to a model, for the commands that make models.
#pragma once

#include <cstdint>
#include <string>

#include "daemon/base/result.h"
#include "daemon/cli/command.h"
#include "daemon/cli/progress.h"
#include "render/reduce/reduce.h"

namespace merlin::cli {

// reduce(), with its progress on stderr and for `listener`, which may be empty. `seconds`: receives
// the time it took. Errors: those of reduce().
Result<render::reduce::Reduction> reduceWithProgress(const render::mesh::Mesh& mesh,
                                                     const render::reduce::ReduceSettings& settings,
                                                     double& seconds,
                                                     const ProgressListener& listener = {});

// A model that is to be made from a mesh.
struct ModelOutput {
  std::string file;        // the model
  std::string named;       // the file that errors about the mesh name
  std::string about;       // lines for the model's text "about"
  std::size_t memory = 0;  // limit of the whole command [bytes]
  unsigned threads = 0;    // 0: all cores
  ProgressListener progress{};
};

// Reduces the mesh by the usual cost, with reduceWithProgress(), and writes the model. Returns the
// number of triangles of its coarsest level. Errors: those of lod::checkNames(),
// roomForReduction(), reduce() and lod::writeMrm().
Result<std::size_t> writeReduced(const ModelOutput& output, const render::mesh::Mesh& mesh,
                                 double& seconds);

// The options --memory and --threads.
void addLimits(Command command, std::uint64_t& memory, unsigned& threads);

}  // namespace merlin::cli
