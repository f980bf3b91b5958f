#include "daemon/cli/mesh/weight_options.h"

#include "daemon/cli/mesh/mesh.h"
#include "render/reduce/reduce.h"

namespace merlin::cli {

void WeightOptions::addTo(Command command, const std::string& preset_help,
                          const std::string& weight_help) {
  std::vector<std::string> presets = {"default"};
  for (const render::reduce::Preset& one : render::reduce::presets())
    presets.emplace_back(one.name);
  command.option("--preset", preset, preset_help).oneOf(presets).showDefault();
  command.option("--weight", weights, weight_help).typeName("FEATURE=W");
}

Result<render::reduce::Weights> WeightOptions::weightsFor(const std::string& cost,
                                                          const render::mesh::Mesh& mesh) const {
  render::reduce::Weights chosen = render::reduce::findCost(cost)->weights(mesh);
  for (const render::reduce::Preset& one : render::reduce::presets()) {
    if (one.name == preset) chosen = render::reduce::presetWeights(one, mesh);
  }
  for (const std::string& text : weights) {
    if (const auto set = setWeight(text, chosen); !set) return set.error();
  }
  return chosen;
}

}  // namespace merlin::cli
