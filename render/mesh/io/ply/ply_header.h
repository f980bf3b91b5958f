// Parses the header of a PLY file: its form, its elements and their properties.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::render::mesh::ply {

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
  Scalar count_type = Scalar::kUint8;  // type of a list's length
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  // Returns the minimum size of one such element [bytes], which limits how many of them a file of a
  // given size can hold.
  std::size_t leastBytes(Form form) const noexcept;
};

struct Header {
  Form form = Form::kAscii;
  std::vector<Element> elements;
  std::vector<std::string> pictures;  // file names in MeshLab's comments "TextureFile", each once
  std::size_t size = 0;               // size of the header [bytes], i.e. the offset of the body
  std::size_t lines = 0;              // number of lines of the header, for messages
};

// Returns whether any vertex property is a texture coordinate (u or v).
bool hasTexcoord(const Header& header);

// Parses the header at the beginning of a PLY file. Errors: kMalformed, with the line number.
Result<Header> parseHeader(std::string_view bytes);

}  // namespace merlin::render::mesh::ply
