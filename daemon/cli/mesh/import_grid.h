// Reads range images and elevation maps through merlin-import, for `merlin mesh import`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/base/result.h"
#include "daemon/cli/mesh/import_range.h"
#include "daemon/cli/mesh/input_kinds.h"
#include "render/range/io/range_file.h"

namespace merlin::cli {

struct ForeignGrid {
  std::string input;
  // Output file of the command; the temporary work folder is made beside it.
  std::string output;
  // Memory limit of merlin-import.
  std::uint64_t memory_bytes = 0;
  std::string hdu{};       // HDU of a FITS file; empty: the first image
  std::string variable{};  // variable of a file with several maps; empty: not given
};

// Lets merlin-import read the file, then reads the result, which is not trusted either. Errors:
// those of importForeign() and of range::readGrid(), with the input's name.
Result<render::range::LoadedRange> readForeignGrid(const ForeignGrid& grid,
                                                   const render::range::RangeOptions& options);

// Returns the reader for loadRange() and a file of this kind: readForeignGrid() for a grid in
// another program's format, otherwise range::readRange(), which supports neither `hdu` nor
// `variable`. grid.input is ignored.
RangeReader readerOf(const std::optional<InputKind>& kind, const ForeignGrid& grid);

}  // namespace merlin::cli
