#include "nn/postures.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
namespace merlin::nn {
namespace {

bool isNameCharacter(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

}  // namespace

bool isPostureName(std::string_view name) noexcept {
  return !name.empty() && name.size() <= kLongestName &&
         std::all_of(name.begin(), name.end(), isNameCharacter);
}

Result<Ok> PostureTable::add(std::uint32_t code, std::string_view name) {
  if (code >= kCodes) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("code {}; allowed: 0 to {}", code, kCodes - 1)};
  }
  if (!isPostureName(name)) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("name \"{}\" of code {}; allowed: 1 to {} letters, digits, - or _",
                             excerpt(name), formatCode(code), kLongestName)};
  }
  if (!this->name(code).empty()) {
    return Error{Errc::kInvalidArgument, fmt::format("code {} is both \"{}\" and \"{}\"",
                                                     formatCode(code), this->name(code), name)};
  }
  if (const auto other = this->code(name)) {
    return Error{Errc::kInvalidArgument, fmt::format("name \"{}\" has two codes, {} and {}", name,
                                                     formatCode(*other), formatCode(code))};
  }
  std::copy(name.begin(), name.end(), names_[code].begin());
  return Ok{};
}

std::string_view PostureTable::name(std::uint32_t code) const noexcept {
  return code < kCodes ? std::string_view(names_[code].data()) : std::string_view();
}

std::optional<std::uint32_t> PostureTable::code(std::string_view name) const noexcept {
  if (name.empty()) return std::nullopt;
  for (std::uint32_t code = 0; code < kCodes; ++code) {
    if (this->name(code) == name) return code;
  }
  return std::nullopt;
}

std::size_t PostureTable::size() const noexcept {
  return static_cast<std::size_t>(
      std::count_if(names_.begin(), names_.end(), [](const auto& name) { return name[0] != 0; }));
}

std::string formatCode(std::uint32_t code) { return fmt::format("{:0{}b}", code, kOutputs); }

std::optional<std::uint32_t> parseCode(std::string_view digits) noexcept {
  if (digits.size() != kOutputs) return std::nullopt;
  std::uint32_t code = 0;
  for (const char c : digits) {
    if (c != '0' && c != '1') return std::nullopt;
    code = code << 1 | (c == '1' ? 1U : 0U);
  }
  return code;
}

Recogniser::Recogniser(const PostureNetwork& network)
    : ranges_(network.ranges), recall_(network.phi, network.weights), postures_(network.postures) {}

Recognition Recogniser::operator()(const Angles& value) const noexcept {
  Recognition r{0, {}, {}, 0};
  float sum = 0;  // NaN if any value is not finite, so that one test suffices for all 23
  for (const float v : value) sum += v * 0;
  if (!(sum == 0)) {
    r.activation.fill(std::numeric_limits<float>::quiet_NaN());
    r.margin = std::numeric_limits<float>::quiet_NaN();
    return r;
  }
  r.activation = recall_(normalise(ranges_, value));
  r.code = threshold(r.activation);
  r.name = postures_.name(r.code);
  r.margin = 1;
  for (const float y : r.activation) r.margin = std::min(r.margin, std::abs(2 * y - 1));
  return r;
}

}  // namespace merlin::nn
