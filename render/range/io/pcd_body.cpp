#include "render/range/io/pcd_body.h"

#include <bit>
#include <cmath>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "daemon/base/bytes.h"
#include "daemon/base/printable_text.h"
#include "render/range/io/lzf.h"
#include "render/range/io/words.h"
#include "render/range/range_image.h"

namespace merlin::render::range {
namespace {

constexpr std::size_t kMostFields = 64, kMostCount = 64, kMostLines = 1000;

std::uint64_t littleEndian(const std::uint8_t* p, std::size_t size) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i) bits |= std::uint64_t{p[i]} << 8 * i;
  return bits;
}

double numberAt(const std::uint8_t* p, const PcdField& field) {
  const std::uint64_t bits = littleEndian(p, field.size);
  if (isPackedColour(field)) return static_cast<double>(bits & 0xFFFFFF);
  if (field.type == 'F')
    return field.size == 4 ? double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))}
                           : std::bit_cast<double>(bits);
  if (field.type == 'U') return static_cast<double>(bits);
  const auto unused = 64 - 8 * field.size;
  // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): the header has 1 to 8 bytes
  return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
}

// Sets one property of all fields from the words of a line, one word per field. Returns false if a
// word is invalid or the number of words differs.
template <typename Set>
bool setFields(std::string_view words, PcdHeader& header, Set set) {
  for (PcdField& field : header.fields) {
    if (!set(takeWord(words), field)) return false;
  }
  return !header.fields.empty() && takeWord(words).empty();
}

bool setNames(std::string_view words, PcdHeader& header) {
  header.fields.clear();
  for (std::string_view word = takeWord(words); !word.empty(); word = takeWord(words)) {
    if (header.fields.size() == kMostFields) return false;
    header.fields.push_back({std::string(excerpt(word))});
  }
  return !header.fields.empty();
}

bool setViewpoint(std::string_view words, PcdHeader& header) {
  const std::vector<double> numbers = numbersOf(words, 7);
  std::copy(numbers.begin(), numbers.end(), header.viewpoint.begin());
  return numbers.size() == 7;
}

bool setCount(std::string_view word, std::size_t& count) {
  return readNumber(trimmed(word), count) && count <= kMostPixels;
}

struct PcdKey {
  const char* name;
  const char* allowed;
  bool (*set)(std::string_view words, PcdHeader&);
};
constexpr PcdKey kPcdKeys[] = {
    {"VERSION", "a number", [](std::string_view, PcdHeader&) { return true; }},
    {"FIELDS", "names, 64 at most", setNames},
    {"COLUMNS", "names, 64 at most", setNames},
    {"SIZE", "1, 2, 4 or 8 for each field",
     [](std::string_view words, PcdHeader& h) {
       return setFields(words, h, [](std::string_view word, PcdField& f) {
         return readNumber(word, f.size) && f.size <= 8 && std::has_single_bit(f.size);
       });
     }},
    {"TYPE", "I, U or F for each field",
     [](std::string_view words, PcdHeader& h) {
       return setFields(words, h, [](std::string_view word, PcdField& f) {
         f.type = word.size() == 1 ? word[0] : '?';
         return f.type == 'I' || f.type == 'U' || f.type == 'F';
       });
     }},
    {"COUNT", "1 to 64 for each field",
     [](std::string_view words, PcdHeader& h) {
       return setFields(words, h, [](std::string_view word, PcdField& f) {
         return readNumber(word, f.count) && f.count >= 1 && f.count <= kMostCount;
       });
     }},
    {"WIDTH", "0 to 268435456",
     [](std::string_view words, PcdHeader& h) { return setCount(words, h.width); }},
    {"HEIGHT", "0 to 268435456",
     [](std::string_view words, PcdHeader& h) { return setCount(words, h.height); }},
    {"VIEWPOINT", "seven numbers", setViewpoint},
    {"POINTS", "0 to 268435456",
     [](std::string_view words, PcdHeader& h) { return setCount(words, h.points); }},
    {"DATA", "ascii, binary or binary_compressed", [](std::string_view words, PcdHeader& h) {
       h.data = trimmed(words);
       return h.data == "ascii" || h.data == "binary" || h.data == "binary_compressed";
     }}};

std::string setKey(std::string_view line, PcdHeader& header) {
  std::string_view words = line;
  const std::string_view key = takeWord(words);
  if (key.empty() || key.starts_with('#')) return {};
  for (const PcdKey& known : kPcdKeys) {
    if (key != known.name) continue;
    if (known.set(words, header)) return {};
    return fmt::format("{}: found \"{}\", allowed: {}", key, oneLine(excerpt(trimmed(words))),
                       known.allowed);
  }
  return fmt::format("\"{}\" is not a line of a PCD header", oneLine(excerpt(line)));
}

std::string headerFault(const PcdHeader& header) {
  for (const PcdField& f : header.fields) {
    if (f.type == 'F' && f.size < 4)
      return fmt::format("field {} is F with {} bytes; allowed are 4 and 8", oneLine(f.name),
                         f.size);
  }
  if (header.fields.empty()) return "FIELDS is missing";
  if (header.width == 0 || header.height == 0 || header.width > kMostPixels / header.height)
    return fmt::format("has {} x {} points; allowed are 1 to {}", header.width, header.height,
                       kMostPixels);
  const std::size_t points = header.width * header.height;
  if (header.points == 0 || header.points == points) return {};
  return fmt::format("POINTS is {}, WIDTH x HEIGHT is {}", header.points, points);
}

std::vector<PcdValues> emptyValues(const PcdHeader& header) {
  std::vector<PcdValues> values;
  for (const PcdField& f : header.fields) values.emplace_back(header.points * f.count);
  return values;
}

Error tooFew(const PcdHeader& header, std::size_t there, std::size_t needed) {
  return {Errc::kMalformed,
          fmt::format("has {} bytes of points; {} x {} points take {}{}", there, header.width,
                      header.height, needed, header.data == "ascii" ? " at least" : "")};
}

// Reads a number in text form. A packed colour may be written as the float that has the same bits.
bool readWord(std::string_view word, const PcdField& field, double& value) {
  if (!readNumber(word, value)) return false;
  if (!isPackedColour(field)) return true;
  if (field.type == 'F') {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    value = bits & 0xFFFFFF;
    return true;
  }
  const bool whole = value >= -2147483648.0 && value <= 4294967295.0;
  value = whole ? static_cast<double>(static_cast<std::int64_t>(value) & 0xFFFFFF) : 0;
  return whole;
}

Result<std::vector<PcdValues>> readAscii(std::string_view text, const PcdHeader& header) {
  std::size_t numbers = 0;
  for (const PcdField& f : header.fields) numbers += f.count;
  if (text.size() / 2 + 1 < header.points * numbers)
    return tooFew(header, text.size(), 2 * header.points * numbers - 1);
  std::vector<PcdValues> values = emptyValues(header);
  for (std::size_t point = 0; point < header.points; ++point) {
    for (std::size_t f = 0; f < values.size(); ++f) {
      const PcdField& field = header.fields[f];
      for (std::size_t i = 0; i < field.count; ++i) {
        const std::string_view word = takeWord(text);
        if (!readWord(word, field, values[f][point * field.count + i]))
          return Error{
              Errc::kMalformed,
              word.empty()
                  ? fmt::format("the file ends after {} of {} points", point, header.points)
                  : fmt::format("point {}: {} is \"{}\", which is not a number", point,
                                oneLine(field.name), oneLine(excerpt(word)))};
      }
    }
  }
  return values;
}

// Reads the numbers of all fields from binary data. `by_field`: true if all numbers of the first
// field come first, then those of the next field; false if all fields of a point are together.
std::vector<PcdValues> readNumbers(const std::uint8_t* bytes, const PcdHeader& header,
                                   bool by_field) {
  std::vector<PcdValues> values = emptyValues(header);
  const std::size_t whole = header.bytesOfPoint();
  std::size_t start = 0;
  for (std::size_t f = 0; f < values.size(); ++f) {
    const PcdField& field = header.fields[f];
    const std::size_t own = field.size * field.count;
    for (std::size_t i = 0; i < values[f].size(); ++i) {
      const std::size_t point = i / field.count * (by_field ? own : whole);
      values[f][i] = numberAt(bytes + start + point + i % field.count * field.size, field);
    }
    start += by_field ? own * header.points : own;
  }
  return values;
}

Result<std::vector<PcdValues>> readCompressed(std::string_view bytes, const PcdHeader& header) {
  const std::size_t needed = header.points * header.bytesOfPoint();
  const auto* p = reinterpret_cast<const std::uint8_t*>(bytes.data());
  if (bytes.size() < 8) return tooFew(header, bytes.size(), needed);
  const std::size_t packed = loadLe32(p), size = loadLe32(p + 4);
  if (size != needed || packed > bytes.size() - 8)
    return Error{
        Errc::kMalformed,
        fmt::format("its {} bytes of compressed points do not fit their sizes, which say {} bytes "
                    "that become {} bytes; {} x {} points take {} bytes",
                    bytes.size() - 8, packed, size, header.width, header.height, needed)};
  const auto unpacked = unpackLzf({p + 8, packed}, size);
  if (!unpacked)
    return Error{Errc::kMalformed, fmt::format("its compressed points are damaged: they do not "
                                               "become {} bytes",
                                               size)};
  return readNumbers(unpacked->data(), header, true);
}

}  // namespace

const PcdValues* findField(const PcdHeader& header, const std::vector<PcdValues>& values,
                           std::string_view name) {
  for (std::size_t f = 0; f < values.size(); ++f) {
    if (header.fields[f].name == name && header.fields[f].count == 1) return &values[f];
  }
  return nullptr;
}

std::vector<float> unpackedColour(const PcdValues& packed) {
  std::vector<float> colour;
  colour.reserve(3 * packed.size());
  for (const double value : packed) {
    const auto bits = static_cast<std::uint32_t>(value);
    for (const unsigned shift : {16U, 8U, 0U})
      colour.push_back(static_cast<float>(bits >> shift & 0xFF) / 255);
  }
  return colour;
}

bool isPackedColour(const PcdField& field) {
  return (field.name == "rgb" || field.name == "rgba") && field.size == 4 && field.count == 1;
}

std::size_t PcdHeader::bytesOfPoint() const {
  std::size_t bytes = 0;
  for (const PcdField& f : fields) bytes += f.size * f.count;
  return bytes;
}

Result<PcdHeader> parsePcdHeader(std::string_view bytes) {
  PcdHeader header;
  std::string_view rest = bytes;
  for (std::size_t line = 1; header.data.empty(); ++line) {
    if (rest.empty() || line > kMostLines)
      return Error{Errc::kMalformed, "has no line DATA, which ends the header"};
    if (const std::string fault = setKey(trimmed(takeLine(rest)), header); !fault.empty())
      return Error{Errc::kMalformed, fmt::format("line {}: {}", line, fault)};
  }
  if (const std::string fault = headerFault(header); !fault.empty())
    return Error{Errc::kMalformed, fault};
  header.points = header.width * header.height;
  header.size = bytes.size() - rest.size();
  return header;
}

Result<std::vector<PcdValues>> readPcdBody(std::string_view bytes, const PcdHeader& header) {
  const std::string_view body = bytes.substr(header.size);
  if (header.data == "ascii") return readAscii(body, header);
  if (header.data == "binary_compressed") return readCompressed(body, header);
  const std::size_t needed = header.points * header.bytesOfPoint();
  if (body.size() < needed) return tooFew(header, body.size(), needed);
  return readNumbers(reinterpret_cast<const std::uint8_t*>(body.data()), header, false);
}

}  // namespace merlin::render::range
