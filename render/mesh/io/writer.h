// MeshWriter: a writer of one mesh file format, i.e. one row of the table of writers in
// mesh_file.cpp. Private to render/mesh/io.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/files.h"
#include "render/mesh/mesh.h"
#include "render/mesh/origin.h"

namespace merlin::render::mesh {

// The place where a format stores the texture image: nowhere, inside the mesh file, or in a
// companion file.
enum class PicturePlace { kNone, kInside, kCompanionFile };

struct MeshWriter {
  const char* ending = nullptr;
  bool (*carries)(const Mesh&,
                  const Feature&) = nullptr;  // whether the format can hold the feature
  // Writes the mesh file; returns false if a write failed. `name`: name prefix of the companion
  // files (plainName()). `origin`: is added to the positions; 0 0 0 unless `exact` is true.
  bool (*write)(const Mesh&, const Origin& origin, const std::string& name,
                const WriteBytes&) = nullptr;
  PicturePlace picture = PicturePlace::kNone;
  bool exact = false;  // whether the format can hold coordinates with more digits than a float
  // Checks that the mesh fits into the format; the error does not contain the file's name. May be
  // null.
  Result<Ok> (*fits)(const Mesh&, const Origin& origin) = nullptr;
  // Returns the content of the companion file NAME.mtl of a textured mesh. May be null.
  std::string (*material)(const Mesh&, const std::string& name) = nullptr;
};

extern const MeshWriter kPlyWriter, kObjWriter, kGlbWriter, kGltfWriter, kStlWriter,
    kInventorWriter;

// Returns whether `f` is "normal", "colour" or "texcoord" in its usual dimension; file formats have
// standard names for these three.
bool isUsual(const Feature& f);

// Returns whether the mesh has a texture image and texture coordinates.
bool isTextured(const Mesh& mesh);

// Returns "NAME.png" or "NAME.jpg", the file name of a textured mesh's image if it is a companion
// file.
std::string pictureName(const Mesh& mesh, const std::string& name);

// Returns whether an image file is a PNG; otherwise it is a JPEG. REQUIRES: `picture` is not empty.
bool isPng(const std::vector<std::uint8_t>& picture);

// Returns the feature with this name and dimension; nullptr if there is none.
const Feature* findOf(const Mesh& mesh, std::string_view name, std::size_t dimension);

}  // namespace merlin::render::mesh
