// How mesh files are written: one file a format, one row of the table in mesh_file.cpp. Private to
// render/mesh/io.
#pragma once

#include <string_view>

#include "daemon/base/files.h"
#include "render/mesh/mesh.h"

namespace merlin::render {

struct MeshWriter {
  const char* ending;
  bool (*carries)(const Feature&);                // whether the format has a place for it
  bool (*write)(const Mesh&, const WriteBytes&);  // false where the file takes no more
  // Whether the mesh fits into the format; the error is without the file's name. May be null.
  Result<Ok> (*fits)(const Mesh&) = nullptr;
  bool textured = false;  // it has a place for the texture's picture
};

extern const MeshWriter kPlyWriter, kObjWriter, kGlbWriter, kGltfWriter, kStlWriter,
    kInventorWriter;

// "normal", "colour" and "texcoord" in their usual dimensions: what formats have names for.
bool isUsual(const Feature& f);

// The feature if it is there in that dimension, else nullptr.
const Feature* findOf(const Mesh& mesh, std::string_view name, std::size_t dimension);

}  // namespace merlin::render
