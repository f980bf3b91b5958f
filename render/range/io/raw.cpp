#include "render/range/io/raw.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "render/range/io/words.h"

namespace merlin::render::range {
namespace {

template <typename T, bool kBigEndian>
double load(const std::uint8_t* p) {
  std::uint8_t bytes[sizeof(T)];
  for (std::size_t i = 0; i < sizeof(T); ++i)
    bytes[i] = p[kBigEndian == (std::endian::native == std::endian::big) ? i : sizeof(T) - 1 - i];
  T value{};
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

constexpr RawType kTypes[] = {
    {"u8", 1, load<std::uint8_t, false>},     {"i8", 1, load<std::int8_t, false>},
    {"u16le", 2, load<std::uint16_t, false>}, {"u16be", 2, load<std::uint16_t, true>},
    {"i16le", 2, load<std::int16_t, false>},  {"i16be", 2, load<std::int16_t, true>},
    {"u32le", 4, load<std::uint32_t, false>}, {"u32be", 4, load<std::uint32_t, true>},
    {"i32le", 4, load<std::int32_t, false>},  {"i32be", 4, load<std::int32_t, true>},
    {"f32le", 4, load<float, false>},         {"f32be", 4, load<float, true>},
    {"f64le", 8, load<double, false>},        {"f64be", 8, load<double, true>}};

Error layoutFault(std::string_view text, std::string_view why) {
  return {Errc::kInvalidArgument,
          fmt::format("\"{}\": {}; allowed: WIDTHxHEIGHT:NAME=TYPE,..., such as "
                      "335x181:range=u16be,confidence=u8",
                      oneLine(excerpt(text)), why)};
}

// Removes the text up to and including the character `end` from `text`, and returns it without
// `end`; if there is no `end`, removes and returns the whole text.
std::string_view takeUntil(std::string_view& text, char end) {
  const std::size_t at = std::min(text.find(end), text.size());
  const std::string_view taken = text.substr(0, at);
  text.remove_prefix(std::min(at + 1, text.size()));
  return taken;
}

std::string addPlane(std::string_view text, RawLayout& layout) {
  constexpr std::size_t kMostPlanes = 64;
  std::string_view type = text;
  const std::string name(takeUntil(type, '='));
  if (name.empty() || type.empty())
    return fmt::format("\"{}\" is not NAME=TYPE", oneLine(excerpt(text)));
  if (layout.planes.size() == kMostPlanes)
    return fmt::format("more than {} planes NAME=TYPE are given", kMostPlanes);
  for (const RawPlane& plane : layout.planes) {
    if (plane.name == name && name != "-") return fmt::format("two planes are named {}", name);
  }
  for (const RawType& row : kTypes) {
    if (type != row.name) continue;
    layout.planes.push_back({name, &row});
    return {};
  }
  return fmt::format("the type \"{}\" is none of {}", oneLine(excerpt(type)), rawTypes());
}

// The position of a plane's values in the file.
struct Place {
  std::size_t start = 0, stride = 0;  // first value, distance between values [bytes]
};
Place placeOf(const RawLayout& layout, std::size_t plane) {
  const std::size_t pixels = layout.width * layout.height;
  Place place{layout.header_bytes, layout.planes[plane].type->bytes};
  for (std::size_t p = 0; p < plane; ++p)
    place.start += layout.planes[p].type->bytes * (layout.interleaved ? 1 : pixels);
  if (!layout.interleaved) return place;
  place.stride = 0;
  for (const RawPlane& p : layout.planes) place.stride += p.type->bytes;
  return place;
}

std::vector<float> valuesAt(std::string_view bytes, const RawLayout& layout, std::size_t plane) {
  const Place place = placeOf(layout, plane);
  const auto* p = reinterpret_cast<const std::uint8_t*>(bytes.data()) + place.start;
  std::vector<float> values(layout.width * layout.height);
  for (std::size_t i = 0; i < values.size(); ++i, p += place.stride)
    values[i] = static_cast<float>(layout.planes[plane].type->load(p));
  return values;
}

}  // namespace

std::string rawTypes() {
  std::string names;
  for (const RawType& type : kTypes)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", type.name);
  return names;
}

Result<RawLayout> parseRawLayout(std::string_view text) {
  RawLayout layout;
  std::string_view rest = text;
  std::string_view size = takeUntil(rest, ':');
  const std::string_view width = takeUntil(size, 'x');
  if (!readNumber(width, layout.width) || !readNumber(size, layout.height) || layout.width == 0 ||
      layout.height == 0)
    return layoutFault(text, "has no size");
  if (layout.width > kMostPixels || layout.height > kMostPixels / layout.width)
    return layoutFault(text, fmt::format("has more than {} pixels", kMostPixels));
  while (!rest.empty()) {
    if (const std::string fault = addPlane(takeUntil(rest, ','), layout); !fault.empty())
      return layoutFault(text, fault);
  }
  for (const RawPlane& plane : layout.planes) {
    if (plane.name == "range") return layout;
  }
  return layoutFault(text, "no plane is named range");
}

Result<StoredImage> parseRaw(std::string_view bytes, const RawLayout& layout) {
  std::size_t pixel = 0;
  for (const RawPlane& plane : layout.planes) pixel += plane.type->bytes;
  const std::size_t pixels = layout.width * layout.height;  // below 2^28, `pixel` below 2^10
  const std::size_t needed = pixels * pixel;
  const std::size_t there = bytes.size() - std::min(bytes.size(), layout.header_bytes);
  if (there < needed)
    return Error{
        Errc::kMalformed,
        fmt::format("has {} bytes after a header of {}; {} x {} pixels of {} bytes take {}", there,
                    layout.header_bytes, layout.width, layout.height, pixel, needed)};
  StoredImage image;
  image.width = layout.width;
  image.height = layout.height;
  if (there > needed)
    image.notes.push_back(fmt::format("{} bytes after the planes are ignored", there - needed));
  for (std::size_t p = 0; p < layout.planes.size(); ++p) {
    const std::string& name = layout.planes[p].name;
    if (name == "range")
      image.values = valuesAt(bytes, layout, p);
    else if (name != "-")
      image.planes.push_back({name, 1, valuesAt(bytes, layout, p)});
  }
  return image;
}

}  // namespace merlin::render::range
