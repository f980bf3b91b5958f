#include "daemon/cli/mesh/outwards.h"

#include <fmt/format.h>

#include "daemon/cli/print.h"

namespace merlin::cli {
namespace {

std::string textOf(const render::mesh::Facing& facing, bool turned) {
  const bool one = facing.inwards == 1;
  if (facing.closed == 0) return "no part is closed; --outwards turned nothing";
  if (facing.inwards == 0) return "no closed part faces inwards; --outwards turned nothing";
  const std::string count = fmt::format("{} of {} closed parts", facing.inwards, facing.closed);
  if (turned)
    return fmt::format("{} faced inwards and {} turned: {} triangles", count, one ? "was" : "were",
                       facing.triangles);
  return fmt::format("{} {} inwards, so that {} would be seen; --outwards turns {}", count,
                     one ? "faces" : "face", one ? "its inside" : "their insides",
                     one ? "it" : "them");
}

}  // namespace

void Outwards::addTo(nlohmann::ordered_json& json) const {
  json["parts_inwards"] = facing.inwards;
  json["triangles_turned"] = turned ? facing.triangles : 0;
}

Outwards faceOutwards(const std::string& file, bool turn, render::mesh::Mesh& mesh) {
  const render::mesh::Parts parts = render::mesh::partsOf(mesh);
  const render::mesh::Facing facing = render::mesh::facingOf(parts);
  if (turn && facing.inwards > 0) render::mesh::turnOutwards(parts, mesh);
  if (turn || facing.inwards > 0) printNote(fmt::format("{}: {}", file, textOf(facing, turn)));
  return {facing, turn};
}

void addOutwards(Command command, bool& outwards) {
  command.flag("--outwards", outwards,
               "Turn closed parts of the surface that face inwards, so that they are seen from "
               "outside; inner walls of hollow bodies and open surfaces stay as they are");
}

}  // namespace merlin::cli
