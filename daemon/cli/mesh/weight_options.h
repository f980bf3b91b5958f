// WeightOptions: the command-line options that set the weights of features.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/cli/arguments.h"
#include "render/mesh/mesh.h"
#include "render/reduce/pattern_space.h"

namespace merlin::cli {

struct WeightOptions {
  std::string preset = "default";
  std::vector<std::string> weights;  // FEATURE=W

  // Adds the options --preset and --weight. `preset_help`, `weight_help`: help texts for this
  // command.
  void addTo(Command command, const std::string& preset_help, const std::string& weight_help);

  bool hasPreset() const { return preset != "default"; }

  // Returns the weights of the preset (by default those of the cost `cost`), with the changes by
  // --weight. Errors: kInvalidArgument (a weight that is not FEATURE=NUMBER). REQUIRES: a cost
  // named `cost` exists.
  Result<render::reduce::Weights> weightsFor(const std::string& cost,
                                             const render::mesh::Mesh& mesh) const;
};

}  // namespace merlin::cli
