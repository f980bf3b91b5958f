// MeshReader: reads one mesh file format; a row of the table of readers in mesh_file.cpp. Private
// to render/mesh/io.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "render/mesh/io/mesh_file.h"
#include "render/mesh/mesh.h"

namespace merlin::render::mesh {

struct MeshReader {
  const char* ending = nullptr;  // in lower case, without the dot
  const char* help = nullptr;    // what is read, for the user
  // Parses a whole file. `folder`: the file's folder with a trailing slash, in which companion
  // files are looked for. The mesh need not be valid or tidy. Errors: kMalformed, kUnsupported,
  // without the file's name.
  Result<LoadedMesh> (*read)(std::string_view content, const std::string& folder) = nullptr;
  // Size of the mesh (not checked), so that it is known before any of it is kept; nothing if it
  // cannot be told. May be null.
  std::optional<MeshFileSize> (*size)(std::string_view content,
                                      const std::string& folder) = nullptr;
  // Whether a file that begins like this is of the format; damage behind that is found by read().
  // Null: only the name's ending tells.
  bool (*is)(std::string_view content) = nullptr;
};

extern const MeshReader kPlyReader, kObjReader, kOffReader, kOmReader, kStlReader;

// Features' values that are no numbers become 0, which a note counts, as in a cloud of points.
// Done by readMeshAs(), and before by a reader that needs a valid mesh.
void replaceNonNumbers(LoadedMesh& loaded);

// As readMesh(), but with `reader`, whatever the file's ending.
Result<LoadedMesh> readMeshAs(const MeshReader& reader, const std::string& path);

}  // namespace merlin::render::mesh
