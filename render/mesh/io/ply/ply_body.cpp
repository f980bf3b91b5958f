#include "render/mesh/io/ply/ply_body.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>

namespace merlin::render::mesh::ply {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr std::uint32_t kMostVertices = std::uint32_t{1} << 31;

bool isSpace(char c) noexcept { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

// Returns the unsigned integer of `size` (1, 2, 4 or 8) bytes at `p`; `big`: whether it is
// big-endian.
std::uint64_t load(const char* p, std::size_t size, bool big) noexcept {
  std::uint64_t v = 0;
  switch (size) {  // with a constant size, memcpy is one load instruction
    case 1: std::memcpy(&v, p, 1); break;
    case 2: std::memcpy(&v, p, 2); break;
    case 4: std::memcpy(&v, p, 4); break;
    default: std::memcpy(&v, p, 8); break;
  }
  return big ? __builtin_bswap64(v) >> (64 - 8 * size) : v;
}

double interpret(std::uint64_t bits, Scalar type) noexcept {
  switch (type) {
    case Scalar::kInt8: return static_cast<std::int8_t>(bits);
    case Scalar::kUint8: return static_cast<std::uint8_t>(bits);
    case Scalar::kInt16: return static_cast<std::int16_t>(bits);
    case Scalar::kUint16: return static_cast<std::uint16_t>(bits);
    case Scalar::kInt32: return static_cast<std::int32_t>(bits);
    case Scalar::kUint32: return static_cast<std::uint32_t>(bits);
    case Scalar::kFloat32: return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    case Scalar::kFloat64: return std::bit_cast<double>(bits);
  }
  return 0;
}

}  // namespace

bool Body::nextWord(double& value) noexcept {
  while (at_ < end_ && isSpace(*at_)) ++at_;
  const char* from = at_ < end_ && *at_ == '+' ? at_ + 1 : at_;
  const auto [end, error] = std::from_chars(from, end_, value);
  if (error != std::errc() || (end < end_ && !isSpace(*end))) return false;
  at_ = end;
  return true;
}

bool Body::nextBinary(Scalar type, double& value) noexcept {
  const std::size_t size = sizeOf(type);
  if (left() < size) return false;
  value = interpret(load(at_, size, form_ == Form::kBigEndian), type);
  at_ += size;
  return true;
}

bool Body::nextTriangle(const Property& list, std::uint32_t* corners) noexcept {
  constexpr std::size_t kSize = 1 + 3 * sizeof(std::uint32_t);
  const bool words = list.type == Scalar::kInt32 || list.type == Scalar::kUint32;
  const bool bytes = list.count_type == Scalar::kUint8 || list.count_type == Scalar::kInt8;
  if (form_ != Form::kLittleEndian || !words || !bytes || left() < kSize || *at_ != 3) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    std::memcpy(&corners[k], at_ + 1 + 4 * k, 4);
    if (corners[k] >= kMostVertices) return false;
  }
  at_ += kSize;
  return true;
}

std::string_view Body::rest() const noexcept {
  std::string_view rest(at_, left());
  rest.remove_prefix(std::min(rest.find_first_not_of(" \r\n\t"), rest.size()));
  return rest.substr(0, std::min<std::size_t>(rest.find_first_of(" \r\n\t"), 16));
}

}  // namespace merlin::render::mesh::ply
