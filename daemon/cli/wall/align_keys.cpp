#include "daemon/cli/wall/align_keys.h"

#include <optional>
#include <utility>

namespace merlin::cli {
namespace {

using What = AlignKey::What;

constexpr char kEscape = '\x1b';
constexpr std::size_t kLongestSequence = 12;

std::optional<AlignKey> plainKey(char c) {
  constexpr std::pair<char, AlignKey> kKeys[] = {{'h', {What::kLeft}},
                                                 {'l', {What::kRight}},
                                                 {'k', {What::kUp}},
                                                 {'j', {What::kDown}},
                                                 {'H', {What::kLeft, true}},
                                                 {'L', {What::kRight, true}},
                                                 {'K', {What::kUp, true}},
                                                 {'J', {What::kDown, true}},
                                                 {'\t', {What::kNextCorner}},
                                                 {'1', {What::kCorner, false, 0}},
                                                 {'2', {What::kCorner, false, 1}},
                                                 {'3', {What::kCorner, false, 2}},
                                                 {'4', {What::kCorner, false, 3}},
                                                 {'n', {What::kNextOutput}},
                                                 {'p', {What::kPreviousOutput}},
                                                 {'s', {What::kFine}},
                                                 {'u', {What::kUndo}},
                                                 {'r', {What::kRedo}},
                                                 {'t', {What::kCard}},
                                                 {'q', {What::kQuit}}};
  for (const auto& [key, means] : kKeys) {
    if (key == c) return means;
  }
  return std::nullopt;
}

// Returns the arrow key for an escape sequence, as xterm and others send them: ESC [ A, ESC O A,
// and with Shift ESC [ 1 ; 2 A; nothing for others.
std::optional<AlignKey> arrowKey(const std::string& sequence) {
  constexpr std::pair<char, What> kArrows[] = {
      {'A', What::kUp}, {'B', What::kDown}, {'C', What::kRight}, {'D', What::kLeft}};
  for (const auto& [last, what] : kArrows) {
    if (sequence.back() != last) continue;
    if (sequence.size() == 3) return AlignKey{what};
    if (sequence.substr(2, 4) == "1;2" + std::string(1, last)) return AlignKey{what, true};
  }
  return std::nullopt;
}

// Returns whether an escape sequence is complete: one that begins with "ESC [" or "ESC O" ends with
// a letter or "~".
bool isWhole(const std::string& sequence) {
  if (sequence.size() < 2) return false;
  if (sequence[1] != '[' && sequence[1] != 'O') return true;
  const char last = sequence.back();
  return sequence.size() > 2 && (last >= '@' && last <= '~');
}

}  // namespace

std::vector<AlignKey> AlignKeyReader::feed(std::string_view bytes) {
  std::vector<AlignKey> keys;
  for (const char c : bytes) {
    std::optional<AlignKey> key;
    if (c == kEscape) {
      pending_ = c;
    } else if (pending_.empty()) {
      key = plainKey(c);
    } else {
      pending_ += c;
      if (!isWhole(pending_) && pending_.size() < kLongestSequence) continue;
      key = arrowKey(pending_);
      pending_.clear();
    }
    if (key) keys.push_back(*key);
  }
  return keys;
}

}  // namespace merlin::cli
