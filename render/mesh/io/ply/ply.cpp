#include "render/mesh/io/ply/ply.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "render/mesh/io/colour_range.h"
#include "render/mesh/io/ply/ply_body.h"
#include "render/mesh/io/ply/ply_header.h"
#include "render/mesh/io/ply/ply_rows.h"
#include "render/mesh/io/ply/ply_strips.h"
#include "render/mesh/io/ply_features.h"
#include "render/mesh/polygon.h"

namespace merlin::render::mesh::ply {
namespace {

// The destination of the values of one vertex property: a column in a table of floats.
struct Column {
  std::vector<float>* values = nullptr;  // null: the property is skipped
  std::size_t stride = 1;
  std::size_t offset = 0;
  float scale = 1;
  bool whole = false;  // the property has an integer type
  double origin = 0;   // is subtracted from each value

  bool isOf(const Column& o) const { return values == o.values && offset == o.offset; }
};

bool isInteger(Scalar type) { return type != Scalar::kFloat32 && type != Scalar::kFloat64; }

const PropertyMapping* mappingOf(std::string_view property) {
  for (const PropertyMapping& k : kPropertyMappings) {
    if (property == k.property) return &k;
  }
  return nullptr;
}

bool isKnownFeature(std::string_view name) {
  return std::any_of(std::begin(kPropertyMappings), std::end(kPropertyMappings),
                     [&](const PropertyMapping& k) { return name == k.feature; });
}

// Returns the factor that turns integer colours into fractions of the range of their type; 1 for
// all other properties.
float scaleOf(const PropertyMapping* known, Scalar type) {
  if (!known || std::string_view(known->feature) != "colour") return 1;
  if (type == Scalar::kUint8) return 1.0F / 255;
  if (type == Scalar::kUint16) return 1.0F / 65535;
  return 1;
}

constexpr std::size_t kNotNumbered = std::numeric_limits<std::size_t>::max();

// Splits "heat_2" into "heat" and 2. For any other name, and if our writer would format the number
// differently ("heat_02"), the number is kNotNumbered.
std::pair<std::string_view, std::size_t> numbered(std::string_view name) {
  const std::size_t bar = name.rfind('_');
  if (bar == std::string_view::npos || bar == 0) return {name, kNotNumbered};
  const std::string_view digits = name.substr(bar + 1);
  std::size_t number = 0;
  const char* end = digits.data() + digits.size();
  const auto [rest, error] = std::from_chars(digits.data(), end, number);
  const bool whole = error == std::errc() && rest == end && fmt::format("{}", number) == digits;
  return whole ? std::pair(name.substr(0, bar), number) : std::pair(name, kNotNumbered);
}

// Joins successive scalars "flow_0", "flow_1", ... to the feature "flow", which our writer has
// split into them.
std::vector<Feature> grouped(std::vector<Feature> features, std::size_t vertices) {
  std::vector<Feature> groups;
  for (std::size_t first = 0, end = 0; first < features.size(); first = end) {
    const auto [base, zero] = numbered(features[first].name);
    for (end = first + 1; zero == 0 && end < features.size(); ++end) {
      if (features[end].dimension != 1 ||
          numbered(features[end].name) != std::pair(base, end - first))
        break;
    }
    const std::size_t n = end - first;
    const std::string name(base);
    const bool taken = std::any_of(features.begin(), features.end(),
                                   [&](const Feature& f) { return f.name == name; });
    if (n == 1 || features[first].dimension != 1 || taken || isKnownFeature(name)) {
      for (std::size_t i = first; i < end; ++i) groups.push_back(std::move(features[i]));
      continue;
    }
    Feature group{name, n, std::vector<float>(vertices * n)};
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t v = 0; v < vertices; ++v)
        group.values[v * n + i] = features[first + i].values[v];
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

// Texture coordinates that mark a corner without texture coordinates.
constexpr std::array<float, 2> kNowhere = {std::numeric_limits<float>::quiet_NaN(),
                                           std::numeric_limits<float>::quiet_NaN()};

class Reader {
 public:
  // `textures`: receives the faces' textures; null: they are left out.
  Reader(std::string_view bytes, Header header, FaceTextures* textures)
      : header_(std::move(header)),
        text_(bytes.substr(header_.size)),
        body_(text_, header_.form),
        textures_(textures) {}

  Result<LoadedMesh> read() {
    for (const Element& e : header_.elements) {
      const auto done = e.name == "vertex"      ? readVertices(e)
                        : e.name == "face"      ? readFaces(e)
                        : e.name == "tristrips" ? readStrips(e)
                                                : skip(e);
      if (!done) return explained(done.error());
    }
    if (const std::string row = body_.rest().empty() ? "" : longRowOfText(); !row.empty())
      return Error{Errc::kMalformed, row};
    completeTextures();
    cutFans();
    takeFacetColours();
    mesh().features = grouped(std::move(mesh().features), mesh().vertexCount());
    noteLosses();
    return std::move(loaded_);
  }

 private:
  Mesh& mesh() { return loaded_.mesh; }

  // Returns a message about the first row of an ASCII file that has too many numbers; empty if
  // there is none. Without this check, such a row would cause an error only later in the file, or
  // none at all.
  std::string longRowOfText() const {
    return header_.form == Form::kAscii ? longRow(text_, header_) : std::string();
  }
  Error explained(const Error& error) const {
    const std::string row = longRowOfText();
    return row.empty() ? error : Error{Errc::kMalformed, row};
  }

  // Returns an error if the rest of the file is too short for the declared count of elements.
  // Called before any memory is allocated.
  Result<Ok> checkRoom(const Element& e) const {
    const std::size_t least = std::max<std::size_t>(e.leastBytes(header_.form), 1);
    const std::size_t room = (body_.left() + 1) / least;
    if (e.count <= room) return Ok{};
    return Error{
        Errc::kMalformed,
        fmt::format("cut short: the header declares {} x {}, the file ends after {} at most",
                    e.count, e.name, room)};
  }

  Error brokenAt(const Element& e, std::uint64_t row, const Property& p) const {
    const std::string_view rest = header_.form == Form::kAscii ? body_.rest() : "";
    return {Errc::kMalformed,
            rest.empty()
                ? fmt::format("cut short in {} {} of {}, property {}", e.name, row, e.count, p.name)
                : fmt::format("{} {}, property {}: \"{}\" is not a number", e.name, row, p.name,
                              excerpt(rest))};
  }

  Result<Ok> skip(const Element& e) {
    leaveOut(e.name, "");
    if (e.properties.empty()) return Ok{};
    for (std::uint64_t row = 0; row < e.count; ++row) {
      for (const Property& p : e.properties) {
        if (const auto done = skipProperty(e, row, p); !done) return done;
      }
    }
    return Ok{};
  }

  Result<Ok> skipProperty(const Element& e, std::uint64_t row, const Property& p) {
    std::uint64_t count = 1;
    if (p.list) {
      const auto length = readLength(e, row, p);
      if (!length) return length.error();
      count = *length;
    }
    for (double value = 0; count > 0; --count) {
      if (!body_.next(p.type, value)) return brokenAt(e, row, p);
    }
    return Ok{};
  }

  Result<std::uint64_t> readLength(const Element& e, std::uint64_t row, const Property& p) {
    double length = 0;
    if (!body_.next(p.count_type, length)) return brokenAt(e, row, p);
    if (length >= 0 && length < 4294967296.0 && length == std::floor(length)) {
      return static_cast<std::uint64_t>(length);
    }
    return Error{Errc::kMalformed, fmt::format("{} {}, property {}: {} is not the length of a list",
                                               e.name, row, p.name, length)};
  }

  Result<std::vector<Column>> planColumns(const Element& e) {
    constexpr std::string_view kAxes = "xyz";
    unsigned axes = 0;  // coordinates that were found, one bit each
    mesh().positions.assign(e.count * 3, 0);
    // Prevents reallocation, since columns point into it.
    mesh().features.reserve(e.properties.size());
    std::vector<Column> columns;
    for (const Property& p : e.properties) {
      Column c;
      if (p.list) {
        leaveOut(p.name, " (a list)");
      } else if (p.name.size() == 1 && kAxes.find(p.name) != std::string_view::npos) {
        c = {&mesh().positions, 3, kAxes.find(p.name), 1};
        axes |= 1U << c.offset;
      } else {
        c = featureColumn(p, e.count);
      }
      const auto same = [&](const Column& o) { return c.values && o.isOf(c); };
      if (std::any_of(columns.begin(), columns.end(), same)) {
        leaveOut(p.name, " (a second property for the same value)");
        c = {};
      }
      c.whole = isInteger(p.type);
      columns.push_back(c);
    }
    if (axes == 0b111) return columns;
    return Error{Errc::kMalformed, "the vertices lack x, y or z"};
  }

  Column featureColumn(const Property& p, std::uint64_t count) {
    const PropertyMapping* known = mappingOf(p.name);
    if (!known && isKnownFeature(p.name)) {  // a scalar "colour" cannot hold three components
      leaveOut(p.name, " (is expected as several properties)");
      return {};
    }
    const std::string name = known ? known->feature : p.name;
    Feature* feature = mesh().find(name);
    if (!feature) {
      const std::size_t dimension = known ? known->dimension : 1;
      mesh().features.push_back({name, dimension, std::vector<float>(count * dimension, 0.0F)});
      feature = &mesh().features.back();
    }
    return {&feature->values, feature->dimension, known ? known->offset : 0,
            scaleOf(known, p.type)};
  }

  Result<Ok> readVertices(const Element& e) {
    if (!mesh().positions.empty()) return Error{Errc::kMalformed, "two vertex elements"};
    if (const auto room = checkRoom(e); !room) return room;
    auto columns = planColumns(e);
    if (!columns) return columns.error();
    std::array<double, 3> first{};
    for (std::uint64_t row = 0; row < e.count; ++row) {
      if (row == 1) setOrigin(e, first, *columns);
      for (std::size_t i = 0; i < e.properties.size(); ++i) {
        const Property& p = e.properties[i];
        const Column& c = (*columns)[i];
        double value = 0;
        if (p.list) {
          if (const auto done = skipProperty(e, row, p); !done) return done;
        } else if (!body_.next(p.type, value)) {
          return brokenAt(e, row, p);
        }
        if (!c.values) continue;
        if (row == 0 && c.values == &mesh().positions) first[c.offset] = value;
        const auto kept = static_cast<float>(value - c.origin);
        if (c.whole && static_cast<double>(kept) != value) ++rounded_;
        (*c.values)[row * c.stride + c.offset] = kept * c.scale;
      }
    }
    if (Feature* const colour = mesh().find("colour")) makeFractions(colour->values);
    return Ok{};
  }

  // Makes coordinates that are doubles relative to an origin near the first vertex. The first
  // vertex has been read already, so it is moved here.
  void setOrigin(const Element& e, const std::array<double, 3>& first,
                 std::vector<Column>& columns) {
    const Origin near = originNear(first);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      Column& c = columns[i];
      if (c.values != &mesh().positions || e.properties[i].type != Scalar::kFloat64) continue;
      c.origin = loaded_.origin[c.offset] = near[c.offset];
      mesh().positions[c.offset] = static_cast<float>(first[c.offset] - c.origin);
    }
  }

  Result<Ok> readFaces(const Element& e) {
    if (const auto room = checkRoom(e); !room) return room;
    mesh().triangles.reserve(std::min<std::uint64_t>(e.count, body_.left()) * 3);
    std::vector<FaceProperty> uses;
    for (const Property& p : e.properties) {
      uses.push_back(useOf(p));
      if (uses.back() == FaceProperty::kNone) leaveOut(p.name, " (a face property)");
    }
    const bool textured =
        std::ranges::any_of(uses, [](FaceProperty u) { return u > FaceProperty::kColour; });
    const bool coloured = std::ranges::find(uses, FaceProperty::kColour) != uses.end();
    for (std::uint64_t row = 0; row < e.count; ++row) {
      const std::size_t before = mesh().triangleCount();
      for (std::size_t i = 0; i < uses.size(); ++i) {
        if (const auto done = readFaceProperty(uses[i], e, row, e.properties[i]); !done)
          return done;
      }
      if (textured) textureFace(before, uses);
      if (coloured) colourFace(before);
    }
    return Ok{};
  }

  enum class FaceProperty { kNone, kCorners, kColour, kTexcoord, kTexnumber };

  FaceProperty useOf(const Property& p) const {
    if (isCorners(p)) return FaceProperty::kCorners;
    const PropertyMapping* const known = p.list ? nullptr : mappingOf(p.name);
    const bool pictures = textures_ && !textures_->pictures.empty();
    if (known && std::string_view(known->feature) == "colour" && !pictures)
      return FaceProperty::kColour;
    if (textures_ && p.list && p.name == "texcoord") return FaceProperty::kTexcoord;
    if (pictures && !p.list && p.name == "texnumber") return FaceProperty::kTexnumber;
    return FaceProperty::kNone;
  }

  Result<Ok> readFaceProperty(FaceProperty use, const Element& e, std::uint64_t row,
                              const Property& p) {
    switch (use) {
      case FaceProperty::kCorners: return readCorners(e, row, p);
      case FaceProperty::kColour: return readFaceColour(e, row, p);
      case FaceProperty::kTexcoord: return readTexcoords(e, row, p);
      case FaceProperty::kTexnumber:
        if (!body_.next(p.type, face_number_)) return brokenAt(e, row, p);
        return Ok{};
      case FaceProperty::kNone: break;
    }
    return skipProperty(e, row, p);
  }

  Result<Ok> readFaceColour(const Element& e, std::uint64_t row, const Property& p) {
    const PropertyMapping* const known = mappingOf(p.name);
    double value = 0;
    if (!body_.next(p.type, value)) return brokenAt(e, row, p);
    face_colour_[known->offset] = static_cast<float>(value) * scaleOf(known, p.type);
    return Ok{};
  }

  void colourFace(std::size_t first) {
    std::vector<float>& all = loaded_.facet_colours;
    all.resize(3 * first, kNoColour);  // for triangles of an earlier element
    for (std::size_t t = first; t < mesh().triangleCount(); ++t)
      all.insert(all.end(), face_colour_.begin(), face_colour_.end());
  }

  // Completes the colours of faces, or drops them if vertices have colours, which are finer.
  void takeFacetColours() {
    std::vector<float>& all = loaded_.facet_colours;
    if (!all.empty() && mesh().find("colour")) {
      all.clear();
      leaveOut("colours", " (of the faces, since the vertices have colours)");
    }
    completeFacetColours(mesh().triangleCount(), all);
  }

  Result<Ok> readTexcoords(const Element& e, std::uint64_t row, const Property& p) {
    const auto count = readLength(e, row, p);
    if (!count) return count.error();
    face_texcoords_.clear();
    double value = 0;
    for (std::uint64_t i = 0; i < *count; ++i) {
      if (!body_.next(p.type, value)) return brokenAt(e, row, p);
      face_texcoords_.push_back(static_cast<float>(value));
    }
    return Ok{};
  }

  // Stores the textures of the last face's triangles, which form a fan around its first corner.
  // first: index of its first triangle.
  void textureFace(std::size_t first, const std::vector<FaceProperty>& uses) {
    const auto has = [&](FaceProperty u) { return std::ranges::find(uses, u) != uses.end(); };
    const std::size_t triangles = mesh().triangleCount() - first;
    if (has(FaceProperty::kTexnumber)) {
      textures_->numbers.resize(first, -1);  // for triangles of an earlier element
      const bool whole = std::abs(face_number_) < 1e9;
      textures_->numbers.resize(first + triangles,
                                whole ? static_cast<std::int64_t>(face_number_) : -1);
    }
    if (!has(FaceProperty::kTexcoord)) return;
    textures_->corners.resize(3 * first, kNowhere);
    const bool all = face_texcoords_.size() == 2 * (triangles + 2);
    for (std::size_t t = 0; t < triangles; ++t) {
      for (const std::size_t corner : {std::size_t{0}, t + 1, t + 2}) {
        textures_->corners.push_back(
            all ? std::array{face_texcoords_[2 * corner], face_texcoords_[2 * corner + 1]}
                : kNowhere);
      }
    }
  }

  // Reads the strips of all rows; a strip ends at -1 or at the end of its row.
  Result<Ok> readStrips(const Element& e) {
    if (const auto room = checkRoom(e); !room) return room;
    for (std::uint64_t row = 0; row < e.count; ++row) {
      for (const Property& p : e.properties) {
        const auto done = isCorners(p) ? readStripRow(e, row, p) : skipProperty(e, row, p);
        if (!done) return done;
      }
    }
    return Ok{};
  }

  Result<Ok> readStripRow(const Element& e, std::uint64_t row, const Property& p) {
    const auto count = readLength(e, row, p);
    if (!count) return count.error();
    StripCutter strip;
    double value = 0;
    for (std::uint64_t i = 0; i < *count; ++i) {
      if (!body_.next(p.type, value)) return brokenAt(e, row, p);
      if (value == -1) {
        strip.end();
      } else if (isIndex(value)) {
        strip.take(static_cast<std::uint32_t>(value), mesh().triangles);
      } else {
        return notAnIndex("tristrips", row, i, value);
      }
    }
    return Ok{};
  }

  static bool isIndex(double value) {
    return value >= 0 && value < 2147483648.0 && value == std::floor(value);
  }

  static Error notAnIndex(const char* element, std::uint64_t row, std::uint64_t corner,
                          double value) {
    return {Errc::kMalformed,
            fmt::format("{} {}: corner {} is {}, not a vertex index", element, row, corner, value)};
  }

  static bool isCorners(const Property& p) {
    return p.list && (p.name == "vertex_indices" || p.name == "vertex_index");
  }

  Result<Ok> readCorners(const Element& e, std::uint64_t row, const Property& p) {
    if (std::uint32_t t[3]; body_.nextTriangle(p, t)) {
      mesh().triangles.insert(mesh().triangles.end(), t, t + 3);
      return Ok{};
    }
    const auto count = readLength(e, row, p);
    if (!count) return count.error();
    if (*count < 3) ++loaded_.tidied.degenerate;
    double value = 0;
    std::uint32_t first = 0, last = 0;
    for (std::uint64_t i = 0; i < *count; ++i) {
      if (!body_.next(p.type, value)) return brokenAt(e, row, p);
      if (!isIndex(value)) return notAnIndex("face", row, i, value);
      const auto v = static_cast<std::uint32_t>(value);
      if (i == 0) first = v;
      if (i >= 2) mesh().triangles.insert(mesh().triangles.end(), {first, last, v});
      last = v;
    }
    if (*count > 3) fans_.take(mesh(), *count);
    return Ok{};
  }

  // Appends entries without texture for the last triangles, if these are strips or faces of an
  // element without textures.
  void completeTextures() {
    if (!textures_) return;
    if (!textures_->numbers.empty()) textures_->numbers.resize(mesh().triangleCount(), -1);
    if (!textures_->corners.empty()) textures_->corners.resize(mesh().triangles.size(), kNowhere);
  }

  // Triangulates faces that are not convex again; the texture coordinates at their corners are
  // reordered accordingly.
  void cutFans() {
    fans_.cut(mesh(), [this](const Fan& fan, std::span<const std::uint32_t> order) {
      if (textures_ && !textures_->corners.empty()) reorder(fan, order, textures_->corners);
    });
  }

  void leaveOut(const std::string& name, std::string_view why) {
    constexpr std::size_t kMostNamed = 8;
    if (++left_out_count_ <= kMostNamed)
      left_out_ += fmt::format("{}{}{}", left_out_.empty() ? "" : ", ", name, why);
    else
      left_out_more_ = fmt::format(" and {} more", left_out_count_ - kMostNamed);
  }

  void noteLosses() {
    if (left_out_count_ > 0) loaded_.notes.push_back("left out: " + left_out_ + left_out_more_);
    if (rounded_ > 0)
      loaded_.notes.push_back(
          fmt::format("{} integers beyond 2^24 were rounded to floats", rounded_));
  }

  Header header_;
  std::string_view text_;  // the whole body of the file
  Body body_;
  LoadedMesh loaded_;
  Fans fans_;
  FaceTextures* textures_;
  std::vector<float> face_texcoords_;   // of the current face
  std::array<float, 3> face_colour_{};  // of the current face
  double face_number_ = -1;
  std::string left_out_, left_out_more_;  // names of properties and elements
  std::size_t left_out_count_ = 0, rounded_ = 0;
};

}  // namespace

Result<LoadedMesh> parse(std::string_view bytes, FaceTextures* textures) {
  auto header = parseHeader(bytes);
  if (!header) return header.error();
  if (textures) textures->pictures = header->pictures;
  return Reader(bytes, std::move(*header), textures).read();
}

}  // namespace merlin::render::mesh::ply
