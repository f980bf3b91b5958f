#include "render/out/kms/choice.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace merlin::render::out::kms {
namespace {

constexpr double kSameRate = 0.5;  // [Hz] a mode named with 60 also means 59.94
constexpr std::size_t kListed = 5;

std::string nameOf(const Mode& mode) {
  return fmt::format("{}x{}@{:.0f}{}", mode.width, mode.height, mode.refresh_hz,
                     mode.interlaced ? "i" : "");
}

// Returns the best of the modes that `fits` accepts: the preferred one, otherwise the fastest.
std::optional<std::size_t> best(std::span<const Mode> modes,
                                const std::function<bool(const Mode&)>& fits) {
  std::optional<std::size_t> found;
  const auto better = [](const Mode& a, const Mode& b) {
    if (a.interlaced != b.interlaced) return b.interlaced;
    if (a.preferred != b.preferred) return a.preferred;
    return a.refresh_hz > b.refresh_hz;
  };
  for (std::size_t i = 0; i < modes.size(); ++i) {
    if (fits(modes[i]) && (!found || better(modes[i], modes[*found]))) found = i;
  }
  return found;
}

std::optional<std::size_t> named(std::span<const Mode> modes, const WantedMode& wanted) {
  const auto same_size = [&](const Mode& m) {
    return m.width == wanted.width && m.height == wanted.height;
  };
  if (wanted.refresh_hz == 0) return best(modes, same_size);
  double nearest = kSameRate;
  for (const Mode& m : modes) {
    if (same_size(m)) nearest = std::min(nearest, std::abs(m.refresh_hz - wanted.refresh_hz));
  }
  return best(modes, [&](const Mode& m) {
    const double off = std::abs(m.refresh_hz - wanted.refresh_hz);
    return same_size(m) && off <= nearest && off < kSameRate;
  });
}

std::optional<std::size_t> unnamed(std::span<const Mode> modes, int width, int height) {
  const auto same = best(modes, [&](const Mode& m) {
    return m.width == width && m.height == height && !m.interlaced;
  });
  if (same) return same;
  const auto preferred = best(modes, [](const Mode& m) { return m.preferred; });
  if (preferred || modes.empty()) return preferred;
  return 0;
}

// Converts whole pixels, and a fixed number of them, so that the compiler uses vector instructions;
// writing single bytes to a buffer may be slow.
template <std::size_t kPixels>
void swapRedAndBlue(const std::uint8_t* from, std::uint8_t* to) {
  std::uint32_t pixels[kPixels];
  std::memcpy(pixels, from, sizeof pixels);
  for (std::uint32_t& p : pixels) p = (p & 0xff00ff00u) | (p >> 16 & 0xffu) | (p & 0xffu) << 16;
  std::memcpy(to, pixels, sizeof pixels);
}

}  // namespace

Result<std::size_t> chooseMode(const Connector& connector, const std::string& wanted,
                               int picture_width, int picture_height) {
  const auto asked = parseMode(wanted);
  const auto found = asked ? named(connector.modes, *asked)
                           : unnamed(connector.modes, picture_width, picture_height);
  if (!found) {
    return Error{Errc::kNotFound,
                 connector.modes.empty()
                     ? fmt::format("the display at {} names no mode", connector.name)
                     : fmt::format("{} has no mode {}; it has {}", connector.name, wanted,
                                   listOf(connector.modes, kListed))};
  }
  const Mode& mode = connector.modes[*found];
  if (picture_width > mode.width || picture_height > mode.height) {
    return Error{
        Errc::kInvalidArgument,
        fmt::format(
            "the picture has {}x{} pixels, more than mode {} of {}; the display has the modes {}",
            picture_width, picture_height, nameOf(mode), connector.name,
            listOf(connector.modes, kListed))};
  }
  return *found;
}

Result<std::size_t> chooseConnector(std::span<const Connector> connectors,
                                    const std::string& wanted, const std::string& card) {
  const auto found = wanted.empty() ? std::ranges::find(connectors, true, &Connector::connected)
                                    : std::ranges::find(connectors, wanted, &Connector::name);
  if (found != connectors.end()) return static_cast<std::size_t>(found - connectors.begin());
  if (wanted.empty() && !connectors.empty()) return std::size_t{0};
  if (connectors.empty()) return Error{Errc::kNotFound, fmt::format("{} has no connector", card)};
  return Error{Errc::kNotFound,
               fmt::format("{} has no connector {}; it has {}", card, wanted, listOf(connectors))};
}

// Augmenting paths (Kuhn): if no CRTC is free, a connector may move an earlier one to another CRTC,
// so that as many connectors as possible get one. At most 32 CRTCs.
std::vector<std::optional<std::size_t>> assignCrtcs(std::span<const std::uint32_t> masks,
                                                    std::uint32_t usable) {
  constexpr std::size_t kMostCrtcs = 32;
  std::vector<std::optional<std::size_t>> owner(kMostCrtcs);
  std::uint32_t seen = 0;
  const auto can = [&](std::size_t connector, std::size_t crtc) {
    return (masks[connector] & usable & ~seen) >> crtc & 1;
  };
  const std::function<bool(std::size_t)> place = [&](std::size_t connector) {
    for (std::size_t crtc = 0; crtc < kMostCrtcs; ++crtc) {
      if (!can(connector, crtc) || owner[crtc]) continue;
      owner[crtc] = connector;
      return true;
    }
    for (std::size_t crtc = 0; crtc < kMostCrtcs; ++crtc) {
      if (!can(connector, crtc)) continue;
      seen |= std::uint32_t{1} << crtc;
      if (!place(*owner[crtc])) continue;
      owner[crtc] = connector;
      return true;
    }
    return false;
  };
  for (std::size_t connector = 0; connector < masks.size(); ++connector) {
    seen = 0;
    place(connector);
  }
  std::vector<std::optional<std::size_t>> assigned(masks.size());
  for (std::size_t crtc = 0; crtc < kMostCrtcs; ++crtc) {
    if (owner[crtc]) assigned[*owner[crtc]] = crtc;
  }
  return assigned;
}

std::string listOf(std::span<const Mode> modes, std::size_t most) {
  std::vector<std::string> names;
  for (const Mode& mode : modes) {
    const std::string name = nameOf(mode);
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  const std::size_t shown = std::min(most, names.size());
  const std::string more =
      shown < names.size() ? fmt::format(" and {} more", names.size() - shown) : "";
  return fmt::format("{}{}", fmt::join(std::span(names).first(shown), ", "), more);
}

std::string listOf(std::span<const Connector> connectors) {
  std::vector<std::string> names;
  for (const Connector& c : connectors) names.push_back(c.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

void writePicture(std::span<const std::uint8_t> rgba, int width, int height,
                  std::span<std::uint8_t> bgrx, std::size_t pitch, int buffer_width,
                  int buffer_height) {
  assert(width <= buffer_width && height <= buffer_height);
  const auto w = static_cast<std::size_t>(width);
  const Corner corner = middle(width, height, buffer_width, buffer_height);
  const auto left = static_cast<std::size_t>(corner.x), top = static_cast<std::size_t>(corner.y);
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    const std::uint8_t* from = rgba.data() + y * w * 4;
    std::uint8_t* to = bgrx.data() + (top + y) * pitch + left * 4;
    std::size_t x = 0;
    for (; x + 16 <= w; x += 16) swapRedAndBlue<16>(from + x * 4, to + x * 4);
    for (; x < w; ++x) swapRedAndBlue<1>(from + x * 4, to + x * 4);
  }
}

}  // namespace merlin::render::out::kms
