// Reads the header and the numbers of a PCD file. Private to render/range/io and render/points/io.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::render::range {

struct PcdField {
  std::string name;
  std::size_t size = 4, count = 1;  // bytes per number, numbers per point
  char type = 'F';                  // I: signed integer, U: unsigned integer, F: floating point
};

struct PcdHeader {
  std::vector<PcdField> fields{};
  std::size_t width = 0, height = 0, points = 0;
  std::array<double, 7> viewpoint = {0, 0, 0, 1, 0, 0, 0};  // translation, quaternion wxyz
  // "ascii", "binary" or "binary_compressed".
  std::string data{};
  // Size of the header: bytes before the points.
  std::size_t size = 0;

  std::size_t bytesOfPoint() const;
};

// Parses the header at the beginning of a PCD file. Errors: kMalformed, with the line if a line is
// at fault; also for more than kMostPixels points.
Result<PcdHeader> parsePcdHeader(std::string_view bytes);

// The numbers of one field: points x count. A packed colour (rgb, rgba) is stored as the number
// whose lower 24 bits are red, green and blue, whatever the field's type.
using PcdValues = std::vector<double>;

// Reads the numbers of all fields, in the order of header.fields; `bytes` is the whole file.
// Errors: kMalformed, for ascii with the number of the point.
Result<std::vector<PcdValues>> readPcdBody(std::string_view bytes, const PcdHeader& header);

// Returns the numbers of the field that has this name and one number per point; nullptr if there is
// none.
const PcdValues* findField(const PcdHeader& header, const std::vector<PcdValues>& values,
                           std::string_view name);

bool isPackedColour(const PcdField& field);

// Returns red, green and blue of each point: points x 3, each 0..1.
std::vector<float> unpackedColour(const PcdValues& packed);

}  // namespace merlin::render::range
