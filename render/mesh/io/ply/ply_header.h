// The header of a PLY file, parsed: which elements follow, of which properties, in which form.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::render::ply {

enum class Form { kAscii, kLittleEndian, kBigEndian };
enum class Scalar : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kFloat32,
  kFloat64
};

std::size_t sizeOf(Scalar type) noexcept;

struct Property {
  std::string name;
  Scalar type = Scalar::kFloat32;
  bool list = false;
  Scalar count_type = Scalar::kUint8;  // of a list's length
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  // The fewest bytes that one of it takes; bounds what a file of a given size can hold.
  std::size_t leastBytes(Form form) const noexcept;
};

struct Header {
  Form form = Form::kAscii;
  std::vector<Element> elements;
  std::vector<std::string> pictures;  // of comments "TextureFile", MeshLab's; each once
  std::size_t size = 0;               // bytes, where the body starts
  std::size_t lines = 0;              // where an ascii body starts, for messages
};

// Whether its vertices have texture coordinates, or one of the two.
bool hasTexcoord(const Header& header);

// Errors: kMalformed, kUnsupported; each names the header's line.
Result<Header> parseHeader(std::string_view bytes);

}  // namespace merlin::render::ply
