// Converts range images and elevation maps in FITS files, and elevation maps in any format that
// GDAL reads, to grids (render/range/io/grid_file.h). Linked only into the program merlin-import,
// which runs it in its sandbox.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::render::import {

struct GridInput {
  std::string path;
  std::string hdu{};       // only for FITS files: see `wanted` of openFits()
  std::string variable{};  // for all other files: see `wanted` of openGdal()
};

struct ImportedGrid {
  std::size_t width = 0, height = 0;  // [pixels]
};

// Loads the modules and data that the libraries need. Call once, before the sandbox closes. Errors:
// kUnsupported.
Result<Ok> prepareGridImport(const char* program);

// Returns the files in the input's folder that describe it, such as those of GTOPO30: files with
// the same name except for the ending, which is one of .hdr, .prj, .blw and a few others.
std::vector<std::string> gridHeadersBeside(const std::string& input);

// Progress callback: receives the share of the work that is done, 0..1, and the number of pixels so
// far.
using OnGridProgress = std::function<void(double share, std::int64_t pixels)>;
// Callback that receives the size as soon as it is known; if it returns an error, the import ends
// with that error.
using OnGridSize = std::function<Result<Ok>(const ImportedGrid&)>;

// Reads `in`, whose content determines the format, and writes the grid to `out`. Rows are streamed.
// Errors, with the file's name and the library's own message: kMalformed, kUnsupported,
// kInvalidArgument (`hdu` or `variable` does not fit the file), kIo (`out` cannot be written), and
// those of opening `in`.
Result<ImportedGrid> importGrid(const GridInput& in, const std::string& out,
                                const OnGridSize& on_size, const OnGridProgress& on_progress);

}  // namespace merlin::render::import
