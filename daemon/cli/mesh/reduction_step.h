// Reduces a mesh to a multiresolution model, for the commands that make models.
#pragma once

#include <cstdint>
#include <string>

#include "daemon/base/result.h"
#include "daemon/cli/command.h"
#include "daemon/cli/progress.h"
#include "render/reduce/reduce.h"

namespace merlin::cli {

// Calls reduce(), and reports its progress on stderr and to `listener`, which may be empty.
// `seconds` is set to the duration unless there is an error. Errors: those of reduce().
Result<render::reduce::Reduction> reduceWithProgress(const render::mesh::Mesh& mesh,
                                                     const render::reduce::ReduceSettings& settings,
                                                     double& seconds,
                                                     const ProgressListener& listener = {});

// A model that is to be made from a mesh.
struct ModelOutput {
  // The model file to write (.mrm).
  std::string file;
  std::string named;       // name of the input, for errors about the mesh
  std::string about;       // lines for the model's text "about"
  std::size_t memory = 0;  // limit of the whole command [bytes]
  unsigned threads = 0;    // 0: all cores
  ProgressListener progress{};
};

// Reduces the mesh with the default cost by reduceWithProgress(), and writes the model. Returns the
// number of triangles of the coarsest level. `seconds` is set to the duration of the reduction.
// Errors: those of lod::checkNames(), roomForReduction(), reduce() and lod::writeMrm().
Result<std::size_t> writeReduced(const ModelOutput& output, const render::mesh::Mesh& mesh,
                                 double& seconds);

// Adds the options --memory and --threads.
void addLimits(Command command, std::uint64_t& memory, unsigned& threads);

}  // namespace merlin::cli
