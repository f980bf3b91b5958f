// Shared by the tests of PLY: small files in all three forms, built from single numbers.
#pragma once

#include <array>
#include <bit>
#include <string>

#include <gtest/gtest.h>

#include "render/mesh/io/ply/ply.h"

namespace merlin::test {

using namespace std::string_literals;
// Reads these bytes as readMesh() does, but without tidying the mesh.
inline Result<render::mesh::LoadedMesh> read(const std::string& bytes) {
  auto loaded = render::mesh::ply::parse(bytes);
  if (!loaded) return loaded;
  if (const auto valid = validate(loaded->mesh); !valid) return valid.error();
  return loaded;
}

// Returns the text with every occurrence of `from` replaced by `to`.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  for (; at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

enum class Form { kAscii, kLittle, kBig };
inline constexpr Form kForms[] = {Form::kAscii, Form::kLittle, Form::kBig};

inline const char* nameOf(Form form) {
  constexpr const char* kNames[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  return kNames[static_cast<std::size_t>(form)];
}

// Builds a body in the given form, number by number.
class Body {
 public:
  explicit Body(Form form) : form_(form) {}

  template <typename T>
  Body& put(T value) {
    if (form_ == Form::kAscii) {
      text_ += (text_.empty() || text_.back() == '\n' ? "" : " ") + std::to_string(value);
      return *this;
    }
    const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    const bool turn = form_ == Form::kBig;
    for (std::size_t i = 0; i < sizeof(T); ++i) text_ += bytes[turn ? sizeof(T) - 1 - i : i];
    return *this;
  }
  Body& line() {
    if (form_ == Form::kAscii) text_ += '\n';
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  Form form_;
  std::string text_;
};

inline std::string header(Form form, const std::string& properties) {
  return std::string("ply\nformat ") + nameOf(form) + " 1.0\ncomment by hand\n" + properties +
         "end_header\n";
}

// Returns a file of a square that consists of a quad and a triangle, with every property that
// MERLIN knows.
inline std::string squareFile(Form form) {
  Body body(form);
  for (int v = 0; v < 4; ++v) {
    body.put(static_cast<float>(v % 2)).put(static_cast<float>(v / 2)).put(0.5F);
    body.put(static_cast<std::uint8_t>(51 * v)).put(std::uint8_t{255}).put(std::uint8_t{0});
    body.put(v * -0.25).line();
  }
  const auto corner = [&](std::int32_t v) { body.put(v); };
  body.put(std::uint8_t{4});
  for (const std::int32_t v : {0, 1, 3, 2}) corner(v);
  body.line().put(std::uint8_t{3});
  for (const std::int32_t v : {0, 1, 3}) corner(v);
  return header(form,
                "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                "property double heat\nelement face 2\n"
                "property list uchar int vertex_indices\n") +
         body.line().text();
}

}  // namespace merlin::test
