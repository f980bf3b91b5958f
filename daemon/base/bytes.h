// Reads and writes numbers in a given byte order, byte by byte: works on machines of any byte order
// and at any alignment. `p` points to as many bytes as the type has.
#pragma once

#include <bit>
#include <cstdint>
#include <string>

namespace merlin {

inline std::uint16_t loadBe16(const std::uint8_t* p) noexcept {
  return static_cast<std::uint16_t>(p[0] << 8 | p[1]);
}
inline std::uint32_t loadBe32(const std::uint8_t* p) noexcept {
  return std::uint32_t{p[0]} << 24 | std::uint32_t{p[1]} << 16 | std::uint32_t{p[2]} << 8 |
         std::uint32_t{p[3]};
}
inline double loadBeDouble(const std::uint8_t* p) noexcept {
  return std::bit_cast<double>(std::uint64_t{loadBe32(p)} << 32 | loadBe32(p + 4));
}
inline std::uint32_t loadLe32(const std::uint8_t* p) noexcept {
  return std::uint32_t{p[0]} | std::uint32_t{p[1]} << 8 | std::uint32_t{p[2]} << 16 |
         std::uint32_t{p[3]} << 24;
}
inline float loadLeFloat(const std::uint8_t* p) noexcept {
  return std::bit_cast<float>(loadLe32(p));
}

inline void storeLe32(std::uint8_t* p, std::uint32_t v) noexcept {
  for (int i = 0; i < 4; ++i) p[i] = static_cast<std::uint8_t>(v >> 8 * i);
}
inline void storeLeFloat(std::uint8_t* p, float v) noexcept {
  storeLe32(p, std::bit_cast<std::uint32_t>(v));
}

inline void appendBe16(std::string& out, std::uint16_t v) {
  out.push_back(static_cast<char>(v >> 8));
  out.push_back(static_cast<char>(v & 0xFF));
}
inline void appendBe32(std::string& out, std::uint32_t v) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(v >> shift & 0xFF));
}
inline void appendBeDouble(std::string& out, double v) {
  const auto bits = std::bit_cast<std::uint64_t>(v);
  appendBe32(out, static_cast<std::uint32_t>(bits >> 32));
  appendBe32(out, static_cast<std::uint32_t>(bits & 0xFFFFFFFF));
}
inline void appendLe32(std::string& out, std::uint32_t v) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<char>(v >> shift & 0xFF));
}
inline void appendLeFloat(std::string& out, float v) {
  appendLe32(out, std::bit_cast<std::uint32_t>(v));
}

}  // namespace merlin
