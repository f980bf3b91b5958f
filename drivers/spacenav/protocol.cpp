#include "drivers/spacenav/protocol.h"

#include <algorithm>
#include <cstring>

namespace merlin::spacenav {
namespace {

constexpr std::int32_t kNameBytes = 24;  // bytes of a name in one piece
constexpr std::int32_t kBytesLeft = 0xFFFF;

// Returns whether a frame may begin with this word.
bool begins(std::int32_t word) noexcept {
  constexpr std::uint32_t kRequestMask = 0xFFFF0000;
  const auto bits = static_cast<std::uint32_t>(word);
  return (word >= kMotion && word <= kRawButton) ||
         (bits & kRequestMask) == (kHello & kRequestMask);
}

}  // namespace

std::optional<Frame> Parser::feed(std::byte byte) noexcept {
  bytes_[length_++] = byte;
  Frame frame{};
  if (length_ < sizeof frame[0]) return std::nullopt;
  std::memcpy(&frame[0], bytes_.data(), sizeof frame[0]);
  if (!begins(frame[0])) {
    ++bad_bytes_;
    if (!lost_) ++bad_packets_;
    lost_ = true;
    // The check rejects a frame at its first word, so the buffer has at most four bytes here.
    std::copy(bytes_.begin() + 1, bytes_.begin() + static_cast<std::ptrdiff_t>(length_),
              bytes_.begin());
    --length_;
    return std::nullopt;
  }
  if (length_ < sizeof frame) return std::nullopt;
  std::memcpy(frame.data(), bytes_.data(), sizeof frame);
  length_ = 0;
  lost_ = false;
  return frame;
}

void Parser::reset() noexcept {
  length_ = 0;
  lost_ = false;
}

std::string encode(const Frame& frame) {
  return {reinterpret_cast<const char*>(frame.data()), sizeof frame};
}

std::string encodeWord(std::uint32_t word) {
  return {reinterpret_cast<const char*>(&word), sizeof word};
}

std::optional<NamePiece> namePiece(const Frame& frame) {
  if (frame[0] != kDeviceName || frame[7] == kFailed) return std::nullopt;
  const std::int32_t left = frame[7] & kBytesLeft;
  const auto* const text = reinterpret_cast<const char*>(&frame[1]);
  NamePiece piece;
  piece.text.assign(text, static_cast<std::size_t>(std::min(left, kNameBytes)));
  piece.text.resize(std::min(piece.text.size(), piece.text.find('\0')));
  piece.complete = left <= kNameBytes;
  return piece;
}

}  // namespace merlin::spacenav
