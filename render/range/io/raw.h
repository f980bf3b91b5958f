// Reads raw binary images whose layout the user describes by a text. This is for files of scanners
// whose layout only the manufacturers know, such as those of Coleman.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "render/range/io/stored_image.h"

namespace merlin::render::range {

struct RawType {
  const char* name;  // name of the type, such as "u16be"
  std::size_t bytes;
  double (*load)(const std::uint8_t*);
};

struct RawPlane {
  std::string name;  // "range", a modality's name, or "-" for a plane that is skipped
  const RawType* type = nullptr;
};

struct RawLayout {
  std::size_t width = 0, height = 0, header_bytes = 0;
  bool interleaved = false;  // true: all planes of a pixel are together; false: plane after plane
  std::vector<RawPlane> planes{};
};

// Parses the description of a layout, such as "335x181:range=u16be,confidence=u8". Types: u8, i8,
// and u16, i16, u32, i32, f32, f64 followed by le or be. Exactly one plane must be named range.
// Errors: kInvalidArgument.
Result<RawLayout> parseRawLayout(std::string_view text);

// Returns the names of the types, "u8, i8, u16le, ...".
std::string rawTypes();

// Reads a raw binary file; `bytes` is the whole file. Errors: kMalformed if the file is smaller
// than the layout.
Result<StoredImage> parseRaw(std::string_view bytes, const RawLayout& layout);

}  // namespace merlin::render::range
