// Reads PLY files and the texture images that a file names; defines a row of the table of readers.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/words.h"
#include "render/image/image_file.h"
#include "render/mesh/atlas/corner_coordinates.h"
#include "render/mesh/atlas/join_textures.h"
#include "render/mesh/io/companion_files.h"
#include "render/mesh/io/ply/ply.h"
#include "render/mesh/io/ply/ply_header.h"
#include "render/mesh/io/ply_features.h"
#include "render/mesh/io/reader.h"
#include "render/mesh/io/texture_pictures.h"
#include "render/mesh/io/writer.h"

namespace merlin::render::mesh {
namespace {

// Reads the texture images that the file names. The entry of an image that cannot be read stays
// empty, and a note explains why.
std::vector<image::ImageFile> picturesOf(const std::vector<std::string>& names,
                                         const std::string& folder,
                                         std::vector<std::string>& notes) {
  std::vector<image::ImageFile> pictures;
  TexturePictures reading;
  CompanionFinder files(folder);
  for (const std::string& name : names) {
    pictures.emplace_back();
    if (name.find('\0') != std::string::npos) {
      notes.push_back(name + ": is not a valid file name; the texture image is left out");
      continue;
    }
    auto picture = reading.read(files.find(name));
    if (picture)
      pictures.back() = *std::move(picture);
    else
      notes.push_back(picture.error().what + "; the texture image is left out");
  }
  if (std::string note = files.note(); !note.empty()) notes.push_back(std::move(note));
  return pictures;
}

bool isNumber(const std::array<float, 2>& uv) {
  return std::isfinite(uv[0]) && std::isfinite(uv[1]);
}

// Returns the texture of each triangle. If the faces have no texture numbers, all of them have the
// only texture.
SurfaceTextures texturesOf(const ply::FaceTextures& faces,
                           const std::vector<image::ImageFile>& pictures, std::size_t triangles) {
  SurfaceTextures all;
  for (const image::ImageFile& p : pictures) all.textures.push_back({&p});
  for (std::size_t t = 0; t < triangles; ++t) {
    const std::int64_t number = faces.numbers.empty() ? 0 : faces.numbers[t];
    const bool there = number >= 0 && static_cast<std::uint64_t>(number) < pictures.size() &&
                       !pictures[static_cast<std::size_t>(number)].pixels.empty();
    const bool placed = faces.corners.empty() ||
                        std::all_of(&faces.corners[3 * t], &faces.corners[3 * t] + 3, isNumber);
    all.of_triangle.push_back(there && placed ? static_cast<std::uint32_t>(number) : kNoTexture);
  }
  return all;
}

// Sets the mesh's texture coordinates from those of the corners. Corners without coordinates get
// (0, 0); no triangle with a texture has such a corner.
void setCoordinates(std::vector<std::array<float, 2>> corners, Mesh& mesh) {
  for (auto& uv : corners) {
    if (!isNumber(uv)) uv = {};
  }
  setCornerCoordinates(mesh, corners);
}

// Reads a PLY file. Texture coordinates of face corners take precedence over those of vertices.
Result<LoadedMesh> read(std::string_view content, const std::string& folder) {
  ply::FaceTextures faces;
  auto loaded = ply::parse(content, &faces);
  if (!loaded) return loaded;
  replaceNonNumbers(*loaded);
  Mesh& mesh = loaded->mesh;
  if (faces.pictures.empty()) {  // the caller may provide a picture separately
    if (faces.corners.empty()) return loaded;
    if (const auto valid = validate(mesh); !valid) return valid.error();
    setCoordinates(faces.corners, mesh);
    return loaded;
  }
  if (faces.corners.empty() && !findOf(mesh, "texcoord", 2)) return loaded;
  if (faces.numbers.empty() && faces.pictures.size() > 1) {
    loaded->notes.push_back(
        fmt::format("left out: {} texture images, since the faces have no property texnumber "
                    "that says which of them each one has",
                    faces.pictures.size()));
    return loaded;
  }
  if (const auto valid = validate(mesh); !valid) return valid.error();
  if (!faces.corners.empty()) setCoordinates(faces.corners, mesh);
  const auto pictures = picturesOf(faces.pictures, folder, loaded->notes);
  const auto notes = joinTextures(mesh, texturesOf(faces, pictures, mesh.triangleCount())).notes();
  loaded->notes.insert(loaded->notes.end(), notes.begin(), notes.end());
  return loaded;
}

bool isPosition(const std::string& property) {
  return property == "x" || property == "y" || property == "z";
}
bool isNormal(const std::string& property) {
  return property == "nx" || property == "ny" || property == "nz";
}

// Estimates the number of triangles of faces with any number of corners, or of strips, on the
// assumption that the file consists of corners apart from its other numbers. Returns nothing if
// there are other lists, whose lengths are unknown.
std::optional<std::size_t> trianglesIn(std::string_view content, const ply::Header& header) {
  const bool ascii = header.form == ply::Form::kAscii;
  std::size_t left =
      ascii ? wordsIn(content.substr(header.size), " \t\r\n") : content.size() - header.size;
  std::size_t faces = 0, corner = 0;  // corner: size of one corner [bytes; words in ASCII]
  for (const ply::Element& e : header.elements) {
    std::size_t fixed = 0;
    for (const ply::Property& p : e.properties) {
      if (p.list && (corner > 0 || (e.name != "face" && e.name != "tristrips")))
        return std::nullopt;
      fixed += ascii ? 1 : ply::sizeOf(p.list ? p.count_type : p.type);
      if (!p.list) continue;
      corner = ascii ? 1 : ply::sizeOf(p.type);
      faces = e.name == "face" ? e.count : 0;  // the number of strips in a list is unknown
    }
    if (fixed > 0 && e.count > left / fixed) return std::nullopt;  // the file is cut short
    left -= e.count * fixed;
  }
  if (corner == 0) return std::nullopt;
  const std::size_t corners = left / corner;
  return corners > 2 * faces ? corners - 2 * faces : 0;
}

bool hasFacetColours(const ply::Header& header) {
  const auto isColour = [](const ply::Property& p) {
    return std::ranges::any_of(ply::kPropertyMappings, [&](const ply::PropertyMapping& m) {
      return p.name == m.property && std::string_view(m.feature) == "colour";
    });
  };
  return std::ranges::any_of(header.elements, [&](const ply::Element& e) {
    return e.name == "face" && std::ranges::any_of(e.properties, isColour);
  });
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
  const auto triangles = trianglesIn(content, *header);
  found.mesh.triangles = std::max(found.mesh.triangles, triangles.value_or(0));
  if (hasFacetColours(*header))  // worst case: one vertex per corner
    found.mesh.vertices = std::max(found.mesh.vertices, 3 * found.mesh.triangles);
  if (header->pictures.empty()) return found;
  constexpr std::size_t kTextured = 40;  // bytes per triangle: coordinates, texture number
  found.meanwhile = kTextured * found.mesh.triangles;
  CompanionFinder files(folder);
  for (const std::string& name : header->pictures)
    if (name.find('\0') == std::string::npos) found.pictures.push_back(files.find(name));
  return found;
}

bool isPly(std::string_view content) {
  return content.starts_with("ply\n") || content.starts_with("ply\r");
}

}  // namespace

const MeshReader kPlyReader = {"ply",
                               "ASCII and binary; every scalar vertex property becomes a feature; "
                               "the texture images that comments TextureFile name",
                               read, size, isPly};

}  // namespace merlin::render::mesh
