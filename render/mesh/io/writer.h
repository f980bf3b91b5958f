// How mesh files are written: one file a format, one row of the table in mesh_file.cpp. Private to
// render/mesh/io.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/files.h"
#include "render/mesh/mesh.h"

namespace merlin::render {

// Where a format has the texture's picture.
enum class PicturePlace { kNone, kInside, kBeside };

struct MeshWriter {
  const char* ending;
  bool (*carries)(const Mesh&, const Feature&);  // whether the format has a place for it
  // False where the file takes no more. `name`: what the names of files beside it begin with.
  bool (*write)(const Mesh&, const std::string& name, const WriteBytes&);
  PicturePlace picture = PicturePlace::kNone;
  // Whether the mesh fits into the format; the error is without the file's name. May be null.
  Result<Ok> (*fits)(const Mesh&) = nullptr;
  // NAME.mtl beside it, where there is a picture. May be null.
  std::string (*material)(const Mesh&, const std::string& name) = nullptr;
};

extern const MeshWriter kPlyWriter, kObjWriter, kGlbWriter, kGltfWriter, kStlWriter,
    kInventorWriter;

// "normal", "colour" and "texcoord" in their usual dimensions: what formats have names for.
bool isUsual(const Feature& f);

// Whether the mesh has a picture and says where it lies.
bool isTextured(const Mesh& mesh);

// "NAME.png" or "NAME.jpg": the picture of a textured mesh in a file of its own.
std::string pictureName(const Mesh& mesh, const std::string& name);

// Whether a picture is a PNG; otherwise it is a JPEG.
bool isPng(const std::vector<std::uint8_t>& picture);

// The feature if it is there in that dimension, else nullptr.
const Feature* findOf(const Mesh& mesh, std::string_view name, std::size_t dimension);

}  // namespace merlin::render
