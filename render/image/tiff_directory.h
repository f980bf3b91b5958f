// One directory (IFD) of a BigTIFF file: reads the few fields that a tiled picture needs, each
// bounded, and none of the rest.
//
// Source: TIFF 6.0 (Adobe, 1992), sections 2, 8, 14, 15; "The BigTIFF File Format Proposal"
// (AWare Systems, 2007): 8-byte offsets and counts, 20-byte entries.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/image/random_access.h"

namespace merlin::render::image {

// Where the values of a field lie in the file. They are read one at a time, so that a table of
// millions of them takes no memory.
struct TiffTable {
  std::uint64_t offset = 0;  // offset of the first value from the file's start [bytes]
  std::uint64_t count = 0;
  int value_size = 0;  // 2, 4 or 8 bytes; 0: the directory lacks the field
};

struct TiffDirectory {
  // Offset of this and of the next directory [bytes]; 0: there is none.
  std::uint64_t offset = 0, next = 0;
  std::uint64_t width = 0, height = 0, tile_width = 0, tile_height = 0;  // [px]
  std::uint64_t compression = 1, photometric = 0, samples = 1, planar = 1, predictor = 1;
  std::uint64_t bits = 0;           // bits of each sample; 0: the samples differ
  std::uint64_t sample_format = 1;  // 1: unsigned integers
  std::string description;
  std::vector<std::uint8_t> jpeg_tables;      // shared by the tiles of a JPEG picture
  std::vector<std::uint64_t> subdirectories;  // offsets
  TiffTable tile_offsets, tile_sizes;
};

// Returns the offset of the first directory [bytes]. Errors: kUnsupported (not a BigTIFF in
// little-endian order), kMalformed, kIo.
Result<std::uint64_t> firstDirectory(const RandomAccess& file);

// Reads the directory at `offset`. Every table that it returns lies within the file. Takes at most
// 200 KB. Errors: kMalformed (with the place and what was found), kIo.
Result<TiffDirectory> readDirectory(const RandomAccess& file, std::uint64_t offset);

// Returns value `index` of a table. REQUIRES: index < table.count, and `table` is from
// readDirectory(). Errors: kMalformed (the file was truncated since), kIo.
Result<std::uint64_t> readValue(const RandomAccess& file, const TiffTable& table,
                                std::uint64_t index);

}  // namespace merlin::render::image
