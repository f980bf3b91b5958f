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

  // Adds --preset and --weight; `preset_help`, `weight_help`: what they mean for this command.
  void addTo(Command command, const std::string& preset_help, const std::string& weight_help);

  bool hasPreset() const { return preset != "default"; }

  // The weights of the preset (by default those of the cost `cost`), changed by --weight. Errors:
  // kInvalidArgument (a weight that is not FEATURE=NUMBER). REQUIRES: there is a cost of that name.
  Result<render::reduce::Weights> weightsFor(const std::string& cost,
                                             const render::mesh::Mesh& mesh) const;
};

}  // namespace merlin::cli
