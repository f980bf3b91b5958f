// Checks whether closed parts of a mesh face inwards, and adds the option --outwards that turns
// them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"
#include "daemon/cli/command.h"
#include "render/mesh/parts.h"

namespace merlin::cli {

// How the closed parts of a mesh face, and whether those that faced inwards were turned.
struct Outwards {
  std::optional<render::mesh::Facing> facing{};  // nothing: not examined, for lack of memory
  bool turned = false;

  // Adds the members parts_inwards (null if not examined) and triangles_turned to `json`.
  void addTo(nlohmann::ordered_json& json) const;
};

// Finds the closed parts that face inwards and, if `turn`, turns them (render/mesh/parts.h). Prints
// a note that names `file` if there are any, or if `turn`. `room`: memory that this may take
// [bytes]. If the memory does not suffice and `turn` is false, prints a note that nothing was
// examined. Errors, with the name of the file: kInvalidArgument (the memory does not suffice, and
// `turn` is true).
Result<Outwards> faceOutwards(const std::string& file, bool turn, std::size_t room,
                              render::mesh::Mesh& mesh);

// Adds the option --outwards.
void addOutwards(Command command, bool& outwards);

}  // namespace merlin::cli
