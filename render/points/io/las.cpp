#include "render/points/io/las.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/bytes.h"
#include "render/points/io/las_projection.h"

namespace merlin::render::points {
namespace {

struct PointFormat {
  std::size_t bytes = 0;   // minimum length of a record
  std::size_t colour = 0;  // offset of red, green and blue in a record; 0: none
  std::size_t time = 0;    // offset of the GPS time in a record; 0: none
  bool infrared = false, waveforms = false;
};
constexpr PointFormat kFormats[] = {{20, 0, 0},
                                    {28, 0, 20},
                                    {26, 20, 0},
                                    {34, 28, 20},
                                    {57, 0, 20, false, true},
                                    {63, 28, 20, false, true},
                                    {30, 0, 22},
                                    {36, 30, 22},
                                    {38, 30, 22, true},
                                    {59, 0, 22, false, true},
                                    {67, 30, 22, true, true}};
// From this format on, the class has a whole byte.
constexpr std::size_t kFirstLongFormat = 6;
constexpr std::size_t kLeastHeader[] = {227, 235, 375};  // bytes, for versions 1.2, 1.3, 1.4
constexpr std::uint8_t kLowNoise = 7, kHighNoise = 18;
constexpr const char* kConvert = "convert it with: pdal translate IN OUT.las";

struct LasHeader {
  int minor = 0;
  std::size_t format = 0, record = 0, start = 0;
  std::uint64_t points = 0;
  std::array<double, 3> scale{}, offset{};
};

class LasBytes {
 public:
  explicit LasBytes(std::string_view bytes)
      : p_(reinterpret_cast<const std::uint8_t*>(bytes.data())) {}

  std::uint8_t u8(std::size_t at) const { return p_[at]; }
  std::uint16_t u16(std::size_t at) const {
    return static_cast<std::uint16_t>(p_[at] | p_[at + 1] << 8);
  }
  std::uint32_t u32(std::size_t at) const { return loadLe32(p_ + at); }
  std::uint64_t u64(std::size_t at) const { return u32(at) | std::uint64_t{u32(at + 4)} << 32; }
  double f64(std::size_t at) const { return std::bit_cast<double>(u64(at)); }

 private:
  const std::uint8_t* p_;
};

Error lasError(Errc code, std::string what) { return {code, "LAS header: " + std::move(what)}; }

Result<Ok> checkVersion(const LasBytes& b, std::size_t size, LasHeader& h) {
  const int major = b.u8(24);
  h.minor = b.u8(25);
  if (major != 1 || h.minor < 2 || h.minor > 4)
    return lasError(
        Errc::kUnsupported,
        fmt::format("version {}.{}; supported are 1.2, 1.3 and 1.4; {}", major, h.minor, kConvert));
  const std::size_t least = kLeastHeader[h.minor - 2], said = b.u16(94);
  if (said < least || said > size)
    return lasError(Errc::kMalformed,
                    fmt::format("its length is {} bytes; version 1.{} has {} at least, the file {}",
                                said, h.minor, least, size));
  return Ok{};
}

Result<Ok> checkScale(const LasHeader& h) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double scale = h.scale[k], offset = h.offset[k];
    if (std::isfinite(scale) && scale > 0 && scale <= 1e9 && std::abs(offset) <= 1e12) continue;
    return lasError(Errc::kMalformed, fmt::format("{}: scale {}, offset {}; a scale is above 0 and "
                                                  "up to 1e9, an offset up to 1e12",
                                                  "xyz"[k], scale, offset));
  }
  return Ok{};
}

// Reads the number of points and the offset of the first point, and checks both against the file's
// size.
Result<Ok> checkRoom(const LasBytes& b, std::size_t size, LasHeader& h) {
  h.start = b.u32(96);
  h.points = h.minor >= 4 ? b.u64(247) : b.u32(107);
  if (h.minor >= 4 && h.points == 0) h.points = b.u32(107);
  if (h.start < b.u16(94) || h.start > size)
    return lasError(Errc::kMalformed,
                    fmt::format("points start at byte {}, the file has {}", h.start, size));
  const std::size_t room = (size - h.start) / h.record;
  if (h.points > room)
    return lasError(Errc::kMalformed,
                    fmt::format("{} points of {} bytes are declared, the file ends after {}",
                                h.points, h.record, room));
  if (h.points == 0) return lasError(Errc::kMalformed, "0 points are declared");
  if (h.points <= kMostPoints) return Ok{};
  return lasError(Errc::kUnsupported,
                  fmt::format("{} points; up to {} are read; thin it with: pdal translate IN "
                              "OUT.las sample --filters.sample.radius=0.1",
                              h.points, kMostPoints));
}

Result<LasHeader> parseLasHeader(std::string_view bytes) {
  if (bytes.size() < kLeastHeader[0])
    return lasError(Errc::kMalformed, fmt::format("cut short: the file has {} bytes, a header {}",
                                                  bytes.size(), kLeastHeader[0]));
  const LasBytes b(bytes);
  LasHeader h;
  if (const auto good = checkVersion(b, bytes.size(), h); !good) return good.error();
  h.format = b.u8(104);
  if ((h.format & 0xC0) != 0)
    return Error{Errc::kUnsupported,
                 "is LAZ, compressed LAS; convert it with: laszip -i IN.laz -o OUT.las"};
  if (h.format >= std::size(kFormats))
    return lasError(Errc::kUnsupported,
                    fmt::format("point format {}; supported are 0 to 10; {}", h.format, kConvert));
  h.record = b.u16(105);
  if (h.record < kFormats[h.format].bytes)
    return lasError(Errc::kMalformed,
                    fmt::format("a point has {} bytes; point format {} takes {} at least", h.record,
                                h.format, kFormats[h.format].bytes));
  for (std::size_t k = 0; k < 3; ++k) {
    h.scale[k] = b.f64(131 + 8 * k);
    h.offset[k] = b.f64(155 + 8 * k);
  }
  if (const auto good = checkScale(h); !good) return good.error();
  if (const auto good = checkRoom(b, bytes.size(), h); !good) return good.error();
  return h;
}

class LasPoints {
 public:
  LasPoints(std::string_view bytes, const LasHeader& header)
      : b_(bytes), h_(header), form_(kFormats[header.format]), colour_at_(form_.colour) {}

  PointCloud read() {
    const auto n = static_cast<std::size_t>(h_.points);
    cloud_.positions.reserve(3 * n);
    intensity_.values.reserve(n);
    label_.values.reserve(n);
    if (colour_at_ > 0) colour_.values.reserve(3 * n);
    cloud_.origin = mesh::originNear(positionOf(h_.start));
    for (std::size_t p = 0; p < n; ++p) add(h_.start + p * h_.record);
    finish();
    return std::move(cloud_);
  }

 private:
  std::array<double, 3> positionOf(std::size_t at) const {
    std::array<double, 3> x{};
    for (std::size_t k = 0; k < 3; ++k)
      x[k] = static_cast<std::int32_t>(b_.u32(at + 4 * k)) * h_.scale[k] + h_.offset[k];
    return x;
  }

  void add(std::size_t at) {
    const bool is_long = h_.format >= kFirstLongFormat;
    const auto kind = static_cast<std::uint8_t>(is_long ? b_.u8(at + 16) : b_.u8(at + 15) & 0x1F);
    const bool withheld = is_long ? (b_.u8(at + 15) & 0x04) != 0 : (b_.u8(at + 15) & 0x80) != 0;
    if (withheld || kind == kLowNoise || kind == kHighNoise) {
      ++(withheld ? withheld_ : noise_);
      return;
    }
    look(at, is_long);
    const auto x = positionOf(at);
    for (std::size_t k = 0; k < 3; ++k)
      cloud_.positions.push_back(static_cast<float>(x[k] - cloud_.origin[k]));
    intensity_.values.push_back(b_.u16(at + 12));
    label_.values.push_back(kind);
    for (std::size_t k = 0; colour_at_ > 0 && k < 3; ++k)
      colour_.values.push_back(b_.u16(at + colour_at_ + 2 * k));
  }

  // Records which data of the point are present but become no feature.
  void look(std::size_t at, bool is_long) {
    const int returns = is_long ? b_.u8(at + 14) >> 4 : b_.u8(at + 14) >> 3 & 7;
    timed_ = timed_ || (form_.time > 0 && b_.u64(at + form_.time) != 0);
    returns_ = returns_ || returns > 1;
    user_data_ = user_data_ || b_.u8(at + 17) != 0;
    sources_ = sources_ || b_.u16(at + (is_long ? 20 : 18)) != 0;
    angles_ = angles_ || (is_long ? b_.u16(at + 18) != 0 : b_.u8(at + 16) != 0);
  }

  // Returns the names of the data that look() found and of further data in the point format; all of
  // these are left out.
  std::string leftOut() const {
    std::string names;
    const auto add = [&](bool there, const std::string& name) {
      if (there) names += (names.empty() ? "" : ", ") + name;
    };
    add(timed_, "GPS time");
    add(returns_, "return numbers");
    add(angles_, "scan angles");
    add(user_data_, "user data");
    add(sources_, "point source IDs");
    add(form_.infrared, "near infrared");
    add(form_.waveforms, "waveforms");
    const std::size_t extra = h_.record - form_.bytes;
    add(extra > 0, fmt::format("{} extra bytes", extra));
    return names;
  }

  // Adds a feature to the cloud, unless it is 0 at every point, which means that it was not
  // recorded.
  void keep(mesh::Feature feature) {
    const bool recorded = std::ranges::any_of(feature.values, [](float v) { return v != 0; });
    if (recorded) cloud_.features.push_back(std::move(feature));
  }

  void finish() {
    const float most = colour_.values.empty() ? 0 : *std::ranges::max_element(colour_.values);
    if (most > 0 && most <= 255) cloud_.notes.emplace_back("its colours are of 8 bits");
    for (float& v : colour_.values) v /= most <= 255 ? 255.0F : 65535.0F;
    keep(std::move(colour_));
    keep(std::move(intensity_));
    keep(std::move(label_));
    std::string dropped = withheld_ > 0 ? fmt::format("{} withheld points", withheld_) : "";
    if (noise_ > 0)
      dropped += fmt::format("{}{} points of noise classes", dropped.empty() ? "" : ", ", noise_);
    if (!dropped.empty()) cloud_.notes.push_back("left out: " + dropped);
    const std::string names = leftOut();
    if (!names.empty())
      cloud_.notes.push_back(
          fmt::format("left out of each point, and not kept as features: {}", names));
    cloud_.side = Side::kAbove;
    cloud_.format = fmt::format("LAS 1.{}, point format {}", h_.minor, h_.format);
  }

  LasBytes b_;
  const LasHeader& h_;
  const PointFormat& form_;
  std::size_t colour_at_;
  bool timed_ = false, returns_ = false, angles_ = false, user_data_ = false, sources_ = false;
  PointCloud cloud_;
  mesh::Feature intensity_{"intensity", 1, {}}, label_{"label", 1, {}}, colour_{"colour", 3, {}};
  std::size_t withheld_ = 0, noise_ = 0;
};

}  // namespace

bool isLas(std::string_view bytes) noexcept { return bytes.starts_with("LASF"); }

Result<PointCloud> parseLas(std::string_view bytes) {
  const auto header = parseLasHeader(bytes);
  if (!header) return header.error();
  PointCloud cloud = LasPoints(bytes, *header).read();
  LasProjection projection = lasProjection(bytes);
  cloud.projection = std::move(projection.text);
  if (!projection.note.empty()) cloud.notes.push_back(std::move(projection.note));
  return cloud;
}

}  // namespace merlin::render::points
