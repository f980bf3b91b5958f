#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pugixml.hpp>

#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"
#include "render/correct/io/archive.h"
#include "render/correct/io/measured_warp.h"
#include "render/correct/io/mpcdi.h"
#include "render/correct/io/pfm.h"
#include "render/image/png_levels.h"

namespace merlin::render::correct {
namespace {

constexpr std::size_t kMostFileBytes = std::size_t{1} << 30;
constexpr std::size_t kMostXmlBytes = std::size_t{1} << 20;
constexpr std::size_t kMostMapBytes = 12 * kMostMeasuredCells + 4096;
constexpr std::size_t kMostRegions = 64;
constexpr std::size_t kLongestId = 64;
constexpr double kMostResolution = 65536;  // [px]
constexpr double kSamePlace = 1e-6;        // shares of a picture that differ less are the same

std::string shownText(std::string_view text) { return oneLine(excerpt(text)); }

// --- the XML; names of elements and attributes are compared case-insensitively ---

bool isNamed(std::string_view name, std::string_view wanted) {
  return std::ranges::equal(name, wanted, [](char a, char b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    return lower(a) == lower(b);
  });
}

pugi::xml_node child(const pugi::xml_node& node, std::string_view name) {
  return node.find_child([&](const pugi::xml_node& n) { return isNamed(n.name(), name); });
}

std::vector<pugi::xml_node> children(const pugi::xml_node& node, std::string_view name) {
  std::vector<pugi::xml_node> found;
  for (const pugi::xml_node& n : node.children()) {
    if (isNamed(n.name(), name)) found.push_back(n);
  }
  return found;
}

pugi::xml_attribute find(const pugi::xml_node& node, std::string_view name) {
  return node.find_attribute([&](const pugi::xml_attribute& a) { return isNamed(a.name(), name); });
}
bool has(const pugi::xml_node& node, std::string_view name) { return !find(node, name).empty(); }
std::string attribute(const pugi::xml_node& node, std::string_view name) {
  return find(node, name).value();
}

// Returns the text of a child element, without surrounding white space.
std::string textOf(const pugi::xml_node& node, std::string_view name) {
  const std::string text = child(node, name).child_value();
  const auto from = text.find_first_not_of(" \t\r\n");
  if (from == std::string::npos) return {};
  return text.substr(from, text.find_last_not_of(" \t\r\n") + 1 - from);
}

// Parses a number in that range; returns nothing for any other text.
std::optional<double> numberIn(const std::string& text, double low, double high) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  if (!whole || !(value >= low && value <= high)) return std::nullopt;
  return value;
}

// Parses a number of pixels, 1 to kMostResolution, which may be written as "640" or "640.0".
std::optional<int> pixelsIn(const std::string& text) {
  const auto value = numberIn(text, 1, kMostResolution);
  if (!value || *value != std::floor(*value)) return std::nullopt;
  return static_cast<int>(*value);
}

Error malformed(const std::string& what) { return {Errc::kMalformed, "mpcdi.xml: " + what}; }

// --- the archive's files ---

struct MapFile {
  std::string path;  // empty: there is none
  double gamma = 1;
};

struct RegionFiles {
  MpcdiRegion region;
  std::string warp;
  std::string interpolation;
  MapFile alpha, beta;
};

Result<MapFile> mapFile(const pugi::xml_node& fileset, const char* name, const std::string& id) {
  const pugi::xml_node node = child(fileset, name);
  if (!node) return MapFile{};
  MapFile file{textOf(node, "path"), 1};
  if (file.path.empty()) return malformed(fmt::format("the {} of region {} has no path", name, id));
  const std::string gamma = textOf(node, "gammaEmbedded");
  const auto value = gamma.empty() ? std::optional(1.0) : numberIn(gamma, 0.1, 10);
  if (!value) {
    return malformed(fmt::format("the {} of region {} has the gamma \"{}\"; allowed is 0.1 to 10",
                                 name, id, shownText(gamma)));
  }
  file.gamma = *value;
  return file;
}

// Returns the gamma with which the colours of a region are decoded; 0 if the file does not define
// one.
Result<double> gammaOf(const pugi::xml_node& region, const std::string& id) {
  const pugi::xml_node decode = child(child(region, "color"), "decode");
  if (!has(decode, "gamma")) return 0.0;
  const std::string gamma = attribute(decode, "gamma");
  const auto value = numberIn(gamma, kLeastGamma, kMostGamma);
  if (value) return *value;
  return malformed(fmt::format("region {} has the decode gamma \"{}\"; allowed is {:g} to {:g}", id,
                               shownText(gamma), kLeastGamma, kMostGamma));
}

// Returns the region's place in its buffer, as text; empty if it is the whole buffer.
std::string partOf(const pugi::xml_node& region) {
  std::vector<std::string> texts;
  bool whole = true;
  for (const auto& [name, of_whole] : {std::pair{"x", 0.0}, std::pair{"y", 0.0},
                                       std::pair{"xSize", 1.0}, std::pair{"ySize", 1.0}}) {
    const std::string text =
        has(region, name) ? attribute(region, name) : fmt::format("{}", of_whole);
    const auto value = numberIn(text, -kMostResolution, kMostResolution);
    whole &= value && std::abs(*value - of_whole) < kSamePlace;
    texts.push_back(value ? fmt::format("{} {:g}", name, *value)
                          : fmt::format("{} \"{}\"", name, shownText(text)));
  }
  return whole ? std::string() : fmt::format("{}", fmt::join(texts, ", "));
}

Result<RegionFiles> regionFiles(const std::string& buffer, const pugi::xml_node& node,
                                const pugi::xml_node& files) {
  RegionFiles r;
  r.region.buffer = buffer;
  r.region.id = attribute(node, "id");
  if (r.region.id.empty() || r.region.id.size() > kLongestId || !isText(r.region.id)) {
    return malformed(fmt::format("a region's id is \"{}\"; allowed are 1 to {} characters",
                                 shownText(r.region.id), kLongestId));
  }
  const std::string id = fmt::format("\"{}\"", r.region.id);
  const std::string across = attribute(node, "xResolution"), down = attribute(node, "yResolution");
  const auto width = pixelsIn(across), height = pixelsIn(down);
  if (!width || !height) {
    return malformed(
        fmt::format("region {} has the size \"{}\" x \"{}\"; xResolution and yResolution are whole "
                    "numbers of 1 to {} pixels",
                    id, shownText(across), shownText(down), kMostResolution));
  }
  r.region.width = *width;
  r.region.height = *height;
  const auto gamma = gammaOf(node, id);
  if (!gamma) return gamma.error();
  r.region.gamma = *gamma;
  r.region.part = partOf(node);
  for (const pugi::xml_node& fileset : children(files, "fileset")) {
    if (attribute(fileset, "region") != r.region.id) continue;
    const pugi::xml_node warp = child(fileset, "geometryWarpFile");
    r.warp = textOf(warp, "path");
    r.interpolation = textOf(warp, "interpolation");
    auto alpha = mapFile(fileset, "alphaMap", id), beta = mapFile(fileset, "betaMap", id);
    if (!alpha) return alpha.error();
    if (!beta) return beta.error();
    r.alpha = *std::move(alpha);
    r.beta = *std::move(beta);
  }
  if (r.warp.empty())
    return malformed(fmt::format("region {} has no fileset with a geometryWarpFile", id));
  return r;
}

Result<std::vector<RegionFiles>> regionsOf(const pugi::xml_document& document) {
  const pugi::xml_node root = child(document, "MPCDI");
  if (!root) return malformed("has no element MPCDI");
  if (const std::string profile = attribute(root, "profile"); profile != "2d") {
    return Error{Errc::kUnsupported,
                 fmt::format("is of profile \"{}\"; only profile 2d is supported, whose warp does "
                             "not depend on the content",
                             shownText(profile))};
  }
  const std::string version = attribute(root, "version");
  if (!version.starts_with("1.") && !version.starts_with("2.") && version != "1" && version != "2")
    return Error{
        Errc::kUnsupported,
        fmt::format("is of version \"{}\"; only 1.x and 2.x are supported", shownText(version))};
  std::vector<RegionFiles> regions;
  for (const pugi::xml_node& buffer : children(child(root, "display"), "buffer")) {
    for (const pugi::xml_node& node : children(buffer, "region")) {
      if (regions.size() == kMostRegions)
        return Error{Errc::kUnsupported, fmt::format("has more than {} regions", kMostRegions)};
      auto region = regionFiles(attribute(buffer, "id"), node, child(root, "files"));
      if (!region) return region.error();
      for (const RegionFiles& other : regions) {
        if (other.region.id == region->region.id)
          return malformed(fmt::format("has two regions \"{}\"", region->region.id));
      }
      regions.push_back(*std::move(region));
    }
  }
  if (regions.empty()) return malformed("has no region");
  return regions;
}

// --- the maps ---

Error at(const std::string& file, const Error& error) {
  return {error.code, fmt::format("{}: {}", shownText(file), error.what)};
}

Result<MeshInterpolation> interpolationOf(const std::string& name) {
  if (name == "smooth") return MeshInterpolation::kBicubic;
  if (name.empty() || name == "linear" || name == "unknown") return MeshInterpolation::kBilinear;
  return Error{
      Errc::kUnsupported,
      fmt::format("its interpolation is \"{}\"; only \"linear\", \"smooth\" and \"unknown\" are "
                  "supported",
                  shownText(name))};
}

using Pixel = std::array<double, 3>;  // 0..1, linear
Pixel pixelOf(const image::Levels& levels, std::size_t i, double gamma) {
  Pixel pixel;
  for (std::size_t c = 0; c < 3; ++c)
    pixel[c] = std::pow(levels.values[3 * i + c] / 65535.0, gamma);
  return pixel;
}

constexpr double kTellable = 1.5 / 255;  // smaller differences are rounding errors of 8-bit maps

// Returns one share per pixel, such that the channels of the pixel are the share times `level`.
// Errors: kUnsupported (a pixel has another colour).
Result<MeasuredShares> sharesFrom(const image::Levels& levels, double gamma, const Pixel& level) {
  MeasuredShares shares{levels.width, levels.height, {}};
  const std::size_t count = levels.values.size() / 3;
  const std::size_t strongest =
      static_cast<std::size_t>(std::ranges::max_element(level) - level.begin());
  shares.shares.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Pixel pixel = pixelOf(levels, i, gamma);
    const double share = level[strongest] > 0 ? pixel[strongest] / level[strongest] : 0;
    for (std::size_t c = 0; c < 3; ++c) {
      if (std::abs(pixel[c] - share * level[c]) <= kTellable) continue;
      return Error{Errc::kUnsupported,
                   fmt::format("its pixel {}, {} has another colour than the rest of the map; only "
                               "one share for all three channels is supported",
                               i % static_cast<std::size_t>(levels.width),
                               i / static_cast<std::size_t>(levels.width))};
    }
    shares.shares.push_back(static_cast<float>(share));
  }
  return shares;
}

bool isGrey(const Pixel& level) {
  return std::ranges::all_of(level, [&](double l) { return std::abs(l - level[0]) <= kTellable; });
}

// Returns the maximum of each channel, as linear light.
Pixel mostOf(const image::Levels& levels, double gamma) {
  std::array<std::uint16_t, 3> most{};
  for (std::size_t i = 0; i < levels.values.size(); ++i)
    most[i % 3] = std::max(most[i % 3], levels.values[i]);
  return pixelOf({1, 1, 3, {most[0], most[1], most[2]}}, 0, gamma);
}

}  // namespace

struct Mpcdi::Content {
  Archive archive;
  std::vector<RegionFiles> regions;

  Result<MeasuredWarp> warp(const RegionFiles& files) const {
    const auto between = interpolationOf(files.interpolation);
    if (!between) return at(files.warp, between.error());
    const auto bytes = archive.read(files.warp, kMostMapBytes);
    if (!bytes) return bytes.error();
    const auto map = parsePfm(*bytes, kMostMeasuredCells);
    if (!map) return at(files.warp, map.error());
    auto warp = measuredWarp(*map, *between, files.region.id);
    return warp ? warp : at(files.warp, warp.error());
  }
  Result<image::Levels> levels(const MapFile& file) const {
    const auto bytes = archive.read(file.path, kMostMapBytes);
    if (!bytes) return bytes.error();
    auto levels = image::decodeLevels(*bytes, kMostMeasuredCells);
    return levels ? levels : at(file.path, levels.error());
  }
};

Mpcdi::Mpcdi(std::unique_ptr<Content> content) : content_(std::move(content)) {}
Mpcdi::Mpcdi(Mpcdi&&) noexcept = default;
Mpcdi& Mpcdi::operator=(Mpcdi&&) noexcept = default;
Mpcdi::~Mpcdi() = default;

Result<Mpcdi> Mpcdi::open(std::span<const std::byte> bytes) {
  auto archive = Archive::open(bytes);
  if (!archive) return archive.error();
  const auto xml = archive->read("mpcdi.xml", kMostXmlBytes);
  if (!xml) return Error{Errc::kMalformed, xml.error().what + "; an MPCDI file has it"};
  pugi::xml_document document;
  const auto parsed = document.load_buffer(xml->data(), xml->size());
  if (!parsed) return malformed(fmt::format("{} at byte {}", parsed.description(), parsed.offset));
  auto regions = regionsOf(document);
  if (!regions) return regions.error();
  return Mpcdi(std::make_unique<Content>(Content{*std::move(archive), *std::move(regions)}));
}

std::vector<MpcdiRegion> Mpcdi::regions() const {
  std::vector<MpcdiRegion> all;
  for (const RegionFiles& files : content_->regions) all.push_back(files.region);
  return all;
}

Result<MeasuredCorrection> Mpcdi::measured(const std::string& region) const {
  const auto& all = content_->regions;
  const auto found = std::ranges::find_if(
      all, [&](const RegionFiles& r) { return region.empty() || r.region.id == region; });
  if (found == all.end() || (region.empty() && all.size() > 1)) {
    std::vector<std::string> ids;
    for (const RegionFiles& r : all) ids.push_back(r.region.id);
    return Error{Errc::kInvalidArgument,
                 region.empty()
                     ? fmt::format("has the regions {}; set mpcdi_region to the output's region",
                                   fmt::join(ids, ", "))
                     : fmt::format("has no region \"{}\"; its regions are {}", shownText(region),
                                   fmt::join(ids, ", "))};
  }
  MeasuredCorrection measured;
  measured.width = found->region.width;
  measured.height = found->region.height;
  auto warp = content_->warp(*found);
  if (!warp) return warp.error();
  measured.warp = *std::move(warp);
  if (const MapFile& file = found->alpha; !file.path.empty()) {
    const auto levels = content_->levels(file);
    if (!levels) return levels.error();
    auto shares = sharesFrom(*levels, file.gamma, {1, 1, 1});
    if (!shares) return at(file.path, shares.error());
    measured.alpha = *std::move(shares);
  }
  if (const MapFile& file = found->beta; !file.path.empty()) {
    const auto levels = content_->levels(file);
    if (!levels) return levels.error();
    const Pixel most = mostOf(*levels, file.gamma);
    if (!isGrey(most)) measured.beta_level = most;
    auto shares = sharesFrom(*levels, file.gamma, measured.beta_level);
    if (!shares) return at(file.path, shares.error());
    measured.beta = *std::move(shares);
  }
  return measured;
}

Result<MeasuredCorrection> readMeasured(const std::string& path, const std::string& region) {
  const auto file = FileCopy::read(path, kMostFileBytes + 1);
  if (!file) return file.error();
  if (file->bytes().size() > kMostFileBytes)
    return Error{Errc::kUnsupported,
                 fmt::format("{}: has more than {} bytes", path, kMostFileBytes)};
  const auto mpcdi = Mpcdi::open(file->bytes());
  if (!mpcdi) return Error{mpcdi.error().code, fmt::format("{}: {}", path, mpcdi.error().what)};
  auto measured = mpcdi->measured(region);
  if (!measured)
    return Error{measured.error().code, fmt::format("{}: {}", path, measured.error().what)};
  return measured;
}

}  // namespace merlin::render::correct
