#include "render/points/io/las_projection.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "daemon/base/words.h"

namespace merlin::render::points {
namespace {

constexpr std::size_t kMostText = 4096;         // limit of the text [bytes]
constexpr std::uint64_t kMostRecords = 10'000;  // limit of records searched

std::uint64_t number(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i)
    value |= std::uint64_t{static_cast<std::uint8_t>(bytes[at + i])} << 8 * i;
  return value;
}

// The contents of the records that describe the projection; empty if a record is missing.
struct Records {
  std::string_view wkt, keys, names;
};

// Searches `count` records from byte `at` on, and stores those about the projection in `found`.
// head: length of a record's header [bytes]; length_bytes: size of the field in it that holds the
// record's length.
void findIn(std::string_view bytes, std::uint64_t at, std::uint64_t count, std::size_t head,
            std::size_t length_bytes, Records& found) {
  constexpr std::size_t kUser = 2, kRecord = 18, kLength = 20;
  for (std::uint64_t i = 0; i < std::min(count, kMostRecords); ++i) {
    if (at > bytes.size() || bytes.size() - at < head) return;
    const std::string_view record = bytes.substr(at);
    const std::uint64_t length = number(record, kLength, length_bytes);
    if (length > record.size() - head) return;
    const std::string_view data = record.substr(head, length);
    const bool projection = record.substr(kUser).starts_with("LASF_Projection");
    const std::uint64_t id = number(record, kRecord, 2);
    if (projection && id == 2112) found.wkt = data;
    if (projection && id == 34735) found.keys = data;
    if (projection && id == 34737) found.names = data;
    at += head + length;
  }
}

// The keys of GeoTIFF: rows of four 16-bit numbers. The first row holds the number of the other
// rows.
class GeoKeys {
 public:
  GeoKeys(std::string_view keys, std::string_view names) : keys_(keys), names_(names) {}

  // Returns the number that is stored in the key's row itself; 0 if there is none.
  std::uint64_t code(std::uint64_t key) const {
    const std::size_t at = rowOf(key);
    return at > 0 && number(keys_, at + 2, 2) == 0 ? number(keys_, at + 6, 2) : 0;
  }
  // Returns the key's text from the record of names; empty if there is none.
  std::string_view name(std::uint64_t key) const {
    const std::size_t at = rowOf(key);
    if (at == 0 || number(keys_, at + 2, 2) != 34737) return {};
    const std::size_t from = number(keys_, at + 6, 2);
    if (from >= names_.size()) return {};
    const std::string_view text = names_.substr(from, number(keys_, at + 4, 2));
    return trimmed(text.substr(0, text.find_first_of(std::string_view("|\0", 2))));
  }

 private:
  static constexpr std::size_t kRow = 8;

  // Returns the offset of the key's row; 0 if there is none.
  std::size_t rowOf(std::uint64_t key) const {
    for (std::size_t at = kRow; at + kRow <= keys_.size(); at += kRow)
      if (number(keys_, at, 2) == key) return at;
    return 0;
  }

  std::string_view keys_, names_;
};

std::string textOf(const GeoKeys& keys) {
  constexpr std::uint64_t kProjected = 3072, kGeographic = 2048, kHeights = 4096;
  constexpr std::uint64_t kNames[] = {3073, 2049, 1026};
  const auto isCode = [](std::uint64_t code) { return code > 0 && code < 32767; };
  for (const std::uint64_t key : {kProjected, kGeographic}) {
    const std::uint64_t code = keys.code(key), heights = keys.code(kHeights);
    if (!isCode(code)) continue;
    return isCode(heights) ? fmt::format("EPSG:{}+{}", code, heights)
                           : fmt::format("EPSG:{}", code);
  }
  for (const std::uint64_t key : kNames) {
    if (!keys.name(key).empty()) return std::string(keys.name(key));
  }
  return {};
}

}  // namespace

LasProjection lasProjection(std::string_view bytes) {
  constexpr std::size_t kMinor = 25, kHeader = 94, kCount = 100, kLater = 235, kLaterCount = 243;
  constexpr std::size_t kHead = 54, kLaterHead = 60;
  Records found;
  findIn(bytes, number(bytes, kHeader, 2), number(bytes, kCount, 4), kHead, 2, found);
  if (bytes[kMinor] >= 4)
    findIn(bytes, number(bytes, kLater, 8), number(bytes, kLaterCount, 4), kLaterHead, 8, found);
  LasProjection projection;
  const std::string_view wkt = trimmed(found.wkt.substr(0, found.wkt.find('\0')), " \t\r\n");
  projection.text = wkt.empty() ? textOf({found.keys, found.names}) : std::string(wkt);
  std::ranges::replace_if(
      projection.text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  const bool usable = projection.text.size() <= kMostText && isText(projection.text);
  if (!usable) projection.text.clear();
  if (projection.text.empty() && (!found.wkt.empty() || !found.keys.empty()))
    projection.note =
        "its projection is left out: its records have neither a text of up to 4096 bytes nor an "
        "EPSG number";
  return projection;
}

}  // namespace merlin::render::points
