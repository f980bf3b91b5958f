// GridSource: interface to a range image or an elevation map that a library reads row by row.
// Private to render/import.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "render/range/io/grid_file.h"

namespace merlin::render::import {

class GridSource {
 public:
  virtual ~GridSource() = default;
  GridSource() = default;
  GridSource(const GridSource&) = delete;
  GridSource& operator=(const GridSource&) = delete;

  virtual const range::GridHead& head() const = 0;
  // Reads the values of a row, counted from the top, into `values` (one per column); missing values
  // become NaN. Returns an empty string, or the library's message on failure.
  virtual std::string readRow(std::size_t row, std::span<float> values) = 0;
};

}  // namespace merlin::render::import
