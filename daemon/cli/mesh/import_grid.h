// Range images and elevation maps of formats that merlin-import reads, for `merlin mesh import`.
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
  std::string output;              // of the command; the work folder lies beside it meanwhile
  std::uint64_t memory_bytes = 0;  // that merlin-import may take
  std::string hdu{};               // of a FITS file; empty: the first image
  std::string variable{};          // of a file of several maps; empty: none is named
};

// Has merlin-import read the file, and reads what it made, which is as hostile as the file. Errors:
// those of importForeign() and of range::readGrid(), with the input's name.
Result<render::range::LoadedRange> readForeignGrid(const ForeignGrid& grid,
                                                   const render::range::RangeOptions& options);

// What loadRange() is to read a file of this kind with: readForeignGrid() for a grid of another
// program's format, else range::readRange(), which takes neither `hdu` nor `variable`. The path of
// `grid` counts for nothing.
RangeReader readerOf(const std::optional<InputKind>& kind, const ForeignGrid& grid);

}  // namespace merlin::cli
