#include "daemon/cli/mesh/outwards.h"

#include <fmt/format.h>

#include "daemon/cli/mesh/mesh_memory.h"
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

Error tooLittle(const std::string& file, std::size_t room) {
  return {Errc::kInvalidArgument,
          fmt::format("{}: finding the parts that --outwards turns takes more than the {} that the "
                      "limit (--memory, by default the free memory) leaves: allow more, or leave "
                      "the option out",
                      file, sizeText(room))};
}

}  // namespace

void Outwards::addTo(nlohmann::ordered_json& json) const {
  if (facing)
    json["parts_inwards"] = facing->inwards;
  else
    json["parts_inwards"] = nullptr;
  json["triangles_turned"] = facing && turned ? facing->triangles : 0;
}

Result<Outwards> faceOutwards(const std::string& file, bool turn, std::size_t room,
                              render::mesh::Mesh& mesh) {
  const auto parts = render::mesh::partsWithin(room, mesh);
  if (!parts && turn) return tooLittle(file, room);
  if (!parts) {
    printNote(
        fmt::format("{}: whether closed parts face inwards was not examined, since that takes "
                    "more than the {} that the limit (--memory, by default the free memory) "
                    "leaves",
                    file, sizeText(room)));
    return Outwards{};
  }
  const render::mesh::Facing facing = render::mesh::facingOf(*parts);
  if (turn && facing.inwards > 0) render::mesh::turnOutwards(*parts, mesh);
  if (turn || facing.inwards > 0) printNote(fmt::format("{}: {}", file, textOf(facing, turn)));
  return Outwards{facing, turn};
}

void addOutwards(Command command, bool& outwards) {
  command.flag("--outwards", outwards,
               "Turn closed parts of the surface that face inwards, so that they are seen from "
               "outside; inner walls of hollow bodies and open surfaces stay as they are");
}

}  // namespace merlin::cli
