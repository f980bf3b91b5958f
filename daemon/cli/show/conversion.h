// The step of `merlin show` from any file to one that merlind shows.
#pragma once

#include <cstdint>
#include <string>

#include "daemon/base/result.h"
#include "daemon/cli/image/image_import.h"
#include "daemon/cli/mesh/mesh_import.h"
#include "daemon/cli/show/file_kind.h"

namespace merlin::cli {

struct Conversion {
  std::string input, output;  // output: a file, or a folder for slides, that is not there yet
  FileKind kind = FileKind::kModel;
  std::uint64_t most_bytes = 0;  // of the output
};

// Makes the output as `merlin mesh import` and `merlin image import` do, by these options, or by a
// copy where nothing is to be converted. Of a folder each picture becomes a slide; what cannot be
// one is left out with a note. Errors: those of the imports and of copyFile(); kUnsupported (larger
// than most_bytes), kNotFound (a folder without a picture).
Result<Ok> convert(const Conversion& conversion, const MeshImport& mesh, const ImageImport& image,
                   const ProgressListener& listener);

}  // namespace merlin::cli
