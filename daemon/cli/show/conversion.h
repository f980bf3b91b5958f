// Converts any supported file to one that merlind can show, for `merlin show`.
#pragma once

#include <cstdint>
#include <string>

#include "daemon/base/result.h"
#include "daemon/cli/image/image_import.h"
#include "daemon/cli/mesh/mesh_import.h"
#include "daemon/cli/show/file_kind.h"

namespace merlin::cli {

struct Conversion {
  std::string input, output;  // output: a file, or a folder for slides; must not exist yet
  FileKind kind = FileKind::kModel;
  std::uint64_t most_bytes = 0;  // limit for the size of the output
};

// Makes the output as `merlin mesh import` or `merlin image import` would with the options `mesh`
// or `image`; copies the file if no conversion is necessary. Each picture in a folder becomes a
// slide; other files are left out with a note. Errors: those of the imports and of copyFile();
// kUnsupported (larger than most_bytes), kNotFound (a folder without a picture).
Result<Ok> convert(const Conversion& conversion, const MeshImport& mesh, const ImageImport& image,
                   const ProgressListener& listener);

}  // namespace merlin::cli
