#include "render/mesh/io/openmesh/stl_colours.h"

#include <array>
#include <cstdint>

namespace merlin::render::mesh {
namespace {

using Colour = std::array<float, 3>;

constexpr unsigned kHighest = 0x8000;

unsigned byteAt(std::string_view bytes, std::size_t at) {
  return static_cast<unsigned char>(bytes[at]);
}

// Returns the five bits from bit `lowest` on as a fraction (0..1).
float channel(unsigned attribute, unsigned lowest) {
  return static_cast<float>((attribute >> lowest) & 31U) / 31.0F;
}

unsigned attributeOf(std::string_view content, std::size_t triangle) {
  const std::size_t at = kStlHeader + kStlTriangle * (triangle + 1) - 2;
  return byteAt(content, at) | byteAt(content, at + 1) << 8;
}

std::size_t trianglesIn(std::string_view content) {
  return (content.size() - kStlHeader) / kStlTriangle;
}

void add(std::vector<float>& to, const Colour& colour) {
  to.insert(to.end(), colour.begin(), colour.end());
}

StlColours coloursOfMagics(std::string_view content, std::size_t object) {
  Colour whole{};
  for (std::size_t k = 0; k < 3; ++k)
    whole[k] = static_cast<float>(byteAt(content, object + k)) / 255.0F;
  bool any = false;
  for (std::size_t t = 0; t < trianglesIn(content) && !any; ++t) any = attributeOf(content, t) != 0;
  StlColours colours;
  for (std::size_t t = 0; t < trianglesIn(content); ++t) {
    const unsigned a = attributeOf(content, t);
    add(colours.of_triangles,
        !any || (a & kHighest) != 0 ? whole : Colour{channel(a, 0), channel(a, 5), channel(a, 10)});
  }
  return colours;
}

StlColours coloursOfVisCam(std::string_view content) {
  StlColours colours;
  bool any = false;
  for (std::size_t t = 0; t < trianglesIn(content); ++t) {
    const unsigned a = attributeOf(content, t);
    const bool has = (a & kHighest) != 0;
    any = any || has;
    colours.unread += !has && a != 0;
    add(colours.of_triangles,
        has ? Colour{channel(a, 10), channel(a, 5), channel(a, 0)} : Colour{1, 1, 1});
  }
  if (!any) colours.of_triangles.clear();
  return colours;
}

}  // namespace

StlColours stlColours(std::string_view content) {
  constexpr std::string_view kMark = "COLOR=";
  constexpr std::size_t kTextBytes = 80;  // bytes of header text; the number of triangles follows
  const std::size_t mark = content.substr(0, kTextBytes).find(kMark);
  if (mark == std::string_view::npos || mark + kMark.size() + 4 > kTextBytes)
    return coloursOfVisCam(content);
  return coloursOfMagics(content, mark + kMark.size());
}

}  // namespace merlin::render::mesh
