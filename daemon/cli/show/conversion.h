// The conversion, in `merlin show`, of any file to one that merlind can show.
#pragma once

#include <cstdint>
#include <string>

#include "daemon/base/result.h"
#include "daemon/cli/image/image_import.h"
#include "daemon/cli/mesh/mesh_import.h"
#include "daemon/cli/show/file_kind.h"

namespace merlin::cli {

struct Conversion {
  std::string input, output;  // output: a file, or a folder for slides, that does not exist yet
  FileKind kind = FileKind::kModel;
  std::uint64_t most_bytes = 0;  // limit of the output's size
};

// Makes the output as `merlin mesh import` and `merlin image import` do with these options, or by
// copying if no conversion is necessary. Each picture of a folder becomes a slide; other files are
// left out with a note. Errors: those of the imports and of copyFile(); kUnsupported (larger than
// most_bytes), kNotFound (a folder without a picture).
Result<Ok> convert(const Conversion& conversion, const MeshImport& mesh, const ImageImport& image,
                   const ProgressListener& listener);

}  // namespace merlin::cli
