// The check of commands that make meshes and models: whether closed parts face inwards, and the
// option --outwards that turns them.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "daemon/cli/command.h"
#include "render/mesh/parts.h"

namespace merlin::cli {

// What was found in a mesh, and whether the parts that face inwards were turned.
struct Outwards {
  render::mesh::Facing facing{};
  bool turned = false;

  // Adds the members parts_inwards and triangles_turned.
  void addTo(nlohmann::ordered_json& json) const;
};

// Finds the closed parts that face inwards and, if `turn`, turns them (render/mesh/parts.h). Prints
// a note that names `file` if there are any, or if `turn`.
Outwards faceOutwards(const std::string& file, bool turn, render::mesh::Mesh& mesh);

// The option --outwards.
void addOutwards(Command command, bool& outwards);

}  // namespace merlin::cli
