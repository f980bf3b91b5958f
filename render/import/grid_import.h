// Makes grids (render/range/io/grid_file.h) of range images and elevation maps in FITS files, and
// of elevation maps of any format that GDAL reads. Only the program merlin-import links this,
// behind its sandbox.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::render::import {

struct GridInput {
  std::string path;
  std::string hdu{};       // of a FITS file: openFits()'s `wanted`
  std::string variable{};  // of any other: openGdal()'s `wanted`
};

struct ImportedGrid {
  std::size_t width = 0, height = 0;  // [pixels]
};

// Loads what the libraries need. To be called once, before the sandbox closes. Errors:
// kUnsupported.
Result<Ok> prepareGridImport(const char* program);

// The files beside the input that describe it, as those of GTOPO30: of the same name but for the
// ending, which is one of a few (.hdr, .prj, .blw, ...).
std::vector<std::string> gridHeadersBeside(const std::string& input);

// Called with the part of the work that is done, 0..1, and the number of pixels so far.
using OnGridProgress = std::function<void(double share, std::int64_t pixels)>;
// Called with the size as soon as it is known; an error ends the import.
using OnGridSize = std::function<Result<Ok>(const ImportedGrid&)>;

// Reads `in`, by its content, and writes the grid to `out`. Rows are streamed. Errors, with the
// file's name and the library's own words: kMalformed, kUnsupported, kIo (`out` cannot be written).
Result<ImportedGrid> importGrid(const GridInput& in, const std::string& out,
                                const OnGridSize& on_size, const OnGridProgress& on_progress);

}  // namespace merlin::render::import
