// How mesh files are read: one row of the table in mesh_file.cpp for each format. Private to
// render/mesh/io.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/io/mesh_file.h"
#include "render/mesh/mesh.h"

namespace merlin::render {

struct MeshReader {
  const char* ending;  // in small letters, without the dot
  const char* help;    // what is read of it, for a person
  // Reads a whole file. `folder`: the file's, with a slash at its end, where files that it names
  // lie. The mesh need not be valid or tidy. Errors: kMalformed, kUnsupported, without the name.
  Result<LoadedMesh> (*read)(std::string_view content, const std::string& folder);
  // Size of the mesh by the file's header, to be told before it is read; nothing if the format does
  // not say. The counts are the file's claim, not checked. May be null.
  std::optional<MeshFileSize> (*size)(std::string_view content,
                                      const std::string& folder) = nullptr;
};

extern const MeshReader kPlyReader, kObjReader, kOffReader, kOmReader, kStlReader;

// readMesh() with one reader, whatever the file's ending.
Result<LoadedMesh> readMeshAs(const MeshReader& reader, const std::string& path);

}  // namespace merlin::render
