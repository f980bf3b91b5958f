// Reads PLY files and the texture image that a file names: a row of the table of readers.
#include <fmt/format.h>

#include "render/image/image_file.h"
#include "render/mesh/io/companion_files.h"
#include "render/mesh/io/ply/ply.h"
#include "render/mesh/io/ply/ply_header.h"
#include "render/mesh/io/reader.h"
#include "render/mesh/io/writer.h"

namespace merlin::render::mesh {
namespace {

// Several texture images are left out: at most the faces of a PLY tell which one they use.
Result<LoadedMesh> read(std::string_view content, const std::string& folder) {
  std::vector<std::string> pictures;
  auto loaded = ply::parse(content, &pictures);
  if (!loaded || pictures.empty() || !findOf(loaded->mesh, "texcoord", 2)) return loaded;
  if (pictures.size() > 1) {
    loaded->notes.push_back(fmt::format("left out: {} texture images", pictures.size()));
    return loaded;
  }
  if (pictures[0].find('\0') != std::string::npos) {
    loaded->notes.push_back(pictures[0] +
                            ": is not a valid file name; the texture image is left out");
    return loaded;
  }
  auto texture = image::readImage(pathBeside(folder, pictures[0]));
  if (texture)
    loaded->mesh.texture = std::move(texture->file);
  else
    loaded->notes.push_back(texture.error().what + "; the texture image is left out");
  return loaded;
}

bool isPosition(const std::string& property) {
  return property == "x" || property == "y" || property == "z";
}
bool isNormal(const std::string& property) {
  return property == "nx" || property == "ny" || property == "nz";
}

std::optional<MeshFileSize> size(std::string_view content, const std::string& folder) {
  const auto header = ply::parseHeader(content);
  if (!header) return std::nullopt;
  MeshFileSize found;
  for (const auto& element : header->elements) {
    if (element.name == "face") found.mesh.triangles = element.count;
    if (element.name != "vertex") continue;
    found.mesh.vertices = element.count;
    for (const auto& p : element.properties)
      found.mesh.values += !p.list && !isPosition(p.name) && !isNormal(p.name);
  }
  if (header->pictures.size() == 1 && ply::hasTexcoord(*header))
    found.picture = pathBeside(folder, header->pictures.front());
  return found;
}

bool isPly(std::string_view content) {
  return content.starts_with("ply\n") || content.starts_with("ply\r");
}

}  // namespace

const MeshReader kPlyReader = {"ply",
                               "ASCII and binary; every scalar vertex property becomes a feature; "
                               "the texture image that a comment TextureFile names",
                               read, size, isPly};

}  // namespace merlin::render::mesh
