// The check of commands that make meshes and models: whether closed parts face inwards, and the
// option --outwards that turns them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"
#include "daemon/cli/command.h"
#include "render/mesh/parts.h"

namespace merlin::cli {

// What was found in a mesh, and whether the parts that face inwards were turned.
struct Outwards {
  std::optional<render::mesh::Facing> facing{};  // nothing: not examined, for lack of memory
  bool turned = false;

  // Adds the members parts_inwards (null if it is not known) and triangles_turned.
  void addTo(nlohmann::ordered_json& json) const;
};

// Finds the closed parts that face inwards and, if `turn`, turns them (render/mesh/parts.h). Prints
// a note that names `file` if there are any, or if `turn`. `room`: memory that this may take
// [bytes]. If it does not suffice, prints a note that nothing was examined. Errors, with the file's
// name: kInvalidArgument (it does not suffice, and `turn`).
Result<Outwards> faceOutwards(const std::string& file, bool turn, std::size_t room,
                              render::mesh::Mesh& mesh);

// The option --outwards.
void addOutwards(Command command, bool& outwards);

}  // namespace merlin::cli
