// MeshWriter: writes one mesh file format; one row of the table of writers in mesh_file.cpp.
// Private to render/mesh/io.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/files.h"
#include "render/mesh/mesh.h"
#include "render/mesh/origin.h"

namespace merlin::render::mesh {

// Where a format stores the texture image: nowhere, inside the mesh file, or in a companion file.
enum class PicturePlace { kNone, kInside, kCompanionFile };

struct MeshWriter {
  const char* ending = nullptr;
  bool (*carries)(const Mesh&,
                  const Feature&) = nullptr;  // whether the format can hold the feature
  // Returns false if a write failed. `name`: name prefix of the companion files (plainName()).
  // `origin`: added to the positions; 0 0 0 unless `exact` is true.
  bool (*write)(const Mesh&, const Origin& origin, const std::string& name,
                const WriteBytes&) = nullptr;
  PicturePlace picture = PicturePlace::kNone;
  bool exact = false;  // whether coordinates may have more digits than a float
  // Checks that the mesh fits into the format; the error does not contain the file's name. May be
  // null.
  Result<Ok> (*fits)(const Mesh&, const Origin& origin) = nullptr;
  // Content of the companion file NAME.mtl of a textured mesh. May be null.
  std::string (*material)(const Mesh&, const std::string& name) = nullptr;
};

extern const MeshWriter kPlyWriter, kObjWriter, kGlbWriter, kGltfWriter, kStlWriter,
    kInventorWriter;

// Whether `f` is "normal", "colour" or "texcoord" in its usual dimension; file formats have names
// of their own for these three.
bool isUsual(const Feature& f);

// Whether the mesh has a texture image and texture coordinates.
bool isTextured(const Mesh& mesh);

// "NAME.png" or "NAME.jpg": file name of a textured mesh's image, if it is a companion file.
std::string pictureName(const Mesh& mesh, const std::string& name);

// Whether an image file, which must not be empty, is a PNG; otherwise it is a JPEG.
bool isPng(const std::vector<std::uint8_t>& picture);

// The feature of this name and dimension; nullptr if there is none.
const Feature* findOf(const Mesh& mesh, std::string_view name, std::size_t dimension);

}  // namespace merlin::render::mesh
