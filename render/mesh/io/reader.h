// MeshReader: a reader of one mesh file format, i.e. one row of the table of readers in
// mesh_file.cpp. Private to render/mesh/io.
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
  const char* help = nullptr;    // description of the data that is read, for the user
  // Parses a whole file. `folder`: the file's folder with a trailing slash, in which companion
  // files are searched for. The mesh need not be valid or tidy. Errors: kMalformed, kUnsupported,
  // without the file's name.
  Result<LoadedMesh> (*read)(std::string_view content, const std::string& folder) = nullptr;
  // Returns the size of the mesh (not checked) before the mesh is loaded; nothing if it cannot be
  // determined. May be null.
  std::optional<MeshFileSize> (*size)(std::string_view content,
                                      const std::string& folder) = nullptr;
  // Returns whether `content`, the beginning of a file, is of this format; read() finds damage
  // later in the file. Null: only the name's ending shows the format.
  bool (*is)(std::string_view content) = nullptr;
};

extern const MeshReader kPlyReader, kObjReader, kOffReader, kOmReader, kStlReader;

// Sets feature values that are not finite numbers to 0 and adds a note with their count.
// readMeshAs() calls this after reading; a reader that needs a valid mesh earlier calls it itself.
void replaceNonNumbers(LoadedMesh& loaded);

// Does what readMesh() does, but uses `reader`, whatever the file's ending is.
Result<LoadedMesh> readMeshAs(const MeshReader& reader, const std::string& path);

}  // namespace merlin::render::mesh
