#include "render/mesh/io/ply/ply_header.h"

#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "render/mesh/io/ply_features.h"
#include "render/mesh/io/text_lines.h"

namespace merlin::render::mesh::ply {
namespace {

constexpr std::size_t kLongestHeader = 64 * 1024;

using Words = std::vector<std::string_view>;

Words split(std::string_view line) {
  Words words;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (line.empty()) return words;
    const std::size_t n = std::min(line.find_first_of(" \t"), line.size());
    words.push_back(line.substr(0, n));
    line.remove_prefix(n);
  }
}

std::optional<Scalar> scalarNamed(std::string_view name) {
  constexpr std::pair<std::string_view, Scalar> kNames[] = {
      {"char", Scalar::kInt8},      {"int8", Scalar::kInt8},       {"uchar", Scalar::kUint8},
      {"uint8", Scalar::kUint8},    {"short", Scalar::kInt16},     {"int16", Scalar::kInt16},
      {"ushort", Scalar::kUint16},  {"uint16", Scalar::kUint16},   {"int", Scalar::kInt32},
      {"int32", Scalar::kInt32},    {"uint", Scalar::kUint32},     {"uint32", Scalar::kUint32},
      {"float", Scalar::kFloat32},  {"float32", Scalar::kFloat32}, {"double", Scalar::kFloat64},
      {"float64", Scalar::kFloat64}};
  for (const auto& [known, type] : kNames) {
    if (known == name) return type;
  }
  return std::nullopt;
}

constexpr std::size_t kLongestName = 255;  // bytes

Error bad(std::size_t line, std::string_view what) {
  return {Errc::kMalformed, fmt::format("line {}: {}", line, what)};
}

class HeaderParser {
 public:
  explicit HeaderParser(std::string_view bytes) : bytes_(bytes.substr(0, kLongestHeader)) {}

  Result<Header> parse() {
    if (nextLine() != "ply") return bad(1, "a PLY file starts with \"ply\"");
    for (;;) {
      const auto line = nextLine();
      if (!line) return bad(header_.lines + 1, "the header has no end_header");
      if (*line == "end_header") break;
      takePicture(*line);
      if (const auto done = keyword(split(*line)); !done) return done.error();
    }
    if (!has_format_) return bad(header_.lines, "the header has no format line");
    header_.size = at_;
    return std::move(header_);
  }

 private:
  std::optional<std::string_view> nextLine() {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string_view::npos) return std::nullopt;
    std::string_view line = bytes_.substr(at_, end - at_);
    if (line.ends_with('\r')) line.remove_suffix(1);
    at_ = end + 1;
    ++header_.lines;
    return line;
  }

  void takePicture(std::string_view line) {
    if (takeWord(line) != "comment" || takeWord(line) != "TextureFile") return;
    std::string name(trimmed(line));
    if (!name.empty() && std::ranges::count(header_.pictures, name) == 0)
      header_.pictures.push_back(std::move(name));
  }

  Result<Ok> keyword(const Words& words) {
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") return Ok{};
    // The length of names is limited, since messages quote them.
    if (words.back().size() > kLongestName || (words.size() > 1 && words[1].size() > kLongestName))
      return bad(header_.lines, fmt::format("a name is longer than {} bytes", kLongestName));
    if (words[0] == "format") return format(words);
    if (words[0] == "element") return element(words);
    if (words[0] == "property") return property(words);
    return bad(header_.lines,
               fmt::format("\"{}\" is not a keyword of a PLY header", excerpt(words[0])));
  }

  Result<Ok> format(const Words& words) {
    constexpr std::pair<std::string_view, Form> kForms[] = {
        {"ascii", Form::kAscii},
        {"binary_little_endian", Form::kLittleEndian},
        {"binary_big_endian", Form::kBigEndian}};
    for (const auto& [name, form] : kForms) {
      if (words.size() != 3 || words[1] != name || words[2] != "1.0") continue;
      header_.form = form;
      has_format_ = true;
      return Ok{};
    }
    return bad(header_.lines,
               "a format is ascii, binary_little_endian or binary_big_endian, version 1.0");
  }

  Result<Ok> element(const Words& words) {
    Element e;
    if (words.size() == 3) {
      const auto [end, error] =
          std::from_chars(words[2].data(), words[2].data() + words[2].size(), e.count);
      if (error == std::errc() && end == words[2].data() + words[2].size()) {
        e.name = words[1];
        header_.elements.push_back(std::move(e));
        return Ok{};
      }
    }
    return bad(header_.lines, "an element has a name and a count: \"element vertex 8\"");
  }

  Result<Ok> property(const Words& words) {
    if (header_.elements.empty()) return bad(header_.lines, "a property before any element");
    Property p;
    p.list = words.size() == 5 && words[1] == "list";
    const auto type = words.size() >= 3 ? scalarNamed(words[words.size() - 2]) : std::nullopt;
    const auto count = p.list ? scalarNamed(words[2]) : Scalar::kUint8;
    if (!type || !count || (!p.list && words.size() != 3)) {
      return bad(header_.lines,
                 "a property is \"property TYPE NAME\" or \"property list TYPE TYPE NAME\"");
    }
    if (p.list && (*count == Scalar::kFloat32 || *count == Scalar::kFloat64)) {
      return bad(header_.lines, "the length of a list must be an integer");
    }
    p.type = *type;
    p.count_type = *count;
    if (!isText(words.back())) return bad(header_.lines, "the property's name is not valid UTF-8");
    p.name = words.back();
    header_.elements.back().properties.push_back(std::move(p));
    return Ok{};
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  bool has_format_ = false;
  Header header_;
};

}  // namespace

std::size_t sizeOf(Scalar type) noexcept {
  constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

std::size_t Element::leastBytes(Form form) const noexcept {
  std::size_t bytes = 0;
  for (const Property& p : properties) {
    bytes += form == Form::kAscii ? 2 : sizeOf(p.list ? p.count_type : p.type);
  }
  return bytes;
}

bool hasTexcoord(const Header& header) {
  for (const Element& e : header.elements) {
    for (const Property& p : e.properties) {
      const auto is = [&](const PropertyMapping& k) {
        return p.name == k.property && std::string_view(k.feature) == "texcoord";
      };
      if (e.name == "vertex" && !p.list && std::ranges::any_of(kPropertyMappings, is)) return true;
    }
  }
  return false;
}

Result<Header> parseHeader(std::string_view bytes) { return HeaderParser(bytes).parse(); }

}  // namespace merlin::render::mesh::ply
