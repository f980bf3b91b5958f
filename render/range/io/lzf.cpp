#include "render/range/io/lzf.h"

#include <cstddef>

namespace merlin::render::range {
namespace {

constexpr std::size_t kMostRatio = 132;  // limit of the compression ratio: 3 bytes give at most 264

}  // namespace

std::optional<std::vector<std::uint8_t>> unpackLzf(std::span<const std::uint8_t> packed,
                                                   std::size_t size) {
  if (size / kMostRatio > packed.size()) return std::nullopt;  // checked before memory is allocated
  std::vector<std::uint8_t> out;
  out.reserve(size);
  for (std::size_t at = 0; at < packed.size();) {
    const std::size_t control = packed[at++];
    if (control < 32) {
      const std::size_t length = control + 1;
      if (packed.size() - at < length || size - out.size() < length) return std::nullopt;
      const auto from = packed.begin() + static_cast<std::ptrdiff_t>(at);
      out.insert(out.end(), from, from + static_cast<std::ptrdiff_t>(length));
      at += length;
      continue;
    }
    std::size_t length = (control >> 5) + 2;
    const bool is_long = length == 9;
    if (packed.size() - at < (is_long ? 2U : 1U)) return std::nullopt;
    if (is_long) length += packed[at++];
    const std::size_t back = ((control & 31) << 8 | packed[at++]) + 1;
    if (back > out.size() || size - out.size() < length) return std::nullopt;
    for (std::size_t i = 0; i < length; ++i) out.push_back(out[out.size() - back]);
  }
  if (out.size() != size) return std::nullopt;
  return out;
}

}  // namespace merlin::render::range
