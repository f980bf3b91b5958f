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
  std::string output;  // output file of the command; the temporary work folder is beside it
  std::uint64_t memory_bytes = 0;  // limit for merlin-import
  std::string hdu{};               // HDU of a FITS file; empty: the first image
  std::string variable{};          // variable of a file with several maps; empty: none is named
};

// Lets merlin-import read the file, then reads the result, which is as untrusted as the file.
// Errors: those of importForeign() and of range::readGrid(), with the input's name.
Result<render::range::LoadedRange> readForeignGrid(const ForeignGrid& grid,
                                                   const render::range::RangeOptions& options);

// The reader that loadRange() needs for a file of this kind: readForeignGrid() for a grid in
// another program's format, otherwise range::readRange(), which takes neither `hdu` nor `variable`.
// The path in `grid` is ignored.
RangeReader readerOf(const std::optional<InputKind>& kind, const ForeignGrid& grid);

}  // namespace merlin::cli
