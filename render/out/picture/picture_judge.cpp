#include "render/out/picture/picture_judge.h"

#include <algorithm>
#include <utility>

namespace merlin::render::out {
namespace {

// Returns whether each cell equals that of one of the two frames.
bool isMixOf(const PictureDigest& found, const PictureDigest& a, const PictureDigest& b) {
  for (std::size_t i = 0; i < PictureDigest::kCells; ++i) {
    if (found.cells[i] != a.cells[i] && found.cells[i] != b.cells[i]) return false;
  }
  return true;
}

bool isTorn(std::span<const MeantPicture> meant, const PictureDigest& found) {
  for (std::size_t i = 0; i < meant.size(); ++i) {
    for (std::size_t j = i + 1; j < meant.size(); ++j)
      if (isMixOf(found, meant[i].digest, meant[j].digest)) return true;
  }
  return false;
}

// Returns the frames that may be shown: the newest, and those that were replaced less than
// kLongestLag before `began`.
std::span<const MeantPicture> showable(std::span<const MeantPicture> meant, Timestamp began) {
  std::size_t oldest = meant.size() - 1;
  while (oldest > 0 && meant[oldest].handed_over > began - kLongestLag) --oldest;
  return meant.subspan(oldest);
}

}  // namespace

PictureVerdict judgePicture(std::span<const MeantPicture> meant, const FoundPicture& found,
                            const std::optional<PictureDigest>& last_right, Timestamp began) {
  if (meant.empty()) return PictureVerdict::kUnchecked;
  if (found.kind == FoundPicture::Kind::kForeign) return PictureVerdict::kForeign;
  const auto expected = showable(meant, began);
  const auto is_found = [&](const MeantPicture& m) { return m.digest == found.digest; };
  const auto is_black = [](const MeantPicture& m) { return m.digest.isBlack(); };
  if (found.kind == FoundPicture::Kind::kOff)
    return std::ranges::any_of(expected, is_black) ? PictureVerdict::kRight
                                                   : PictureVerdict::kBlack;
  if (std::ranges::any_of(expected, is_found)) return PictureVerdict::kRight;
  if (found.digest.isBlack()) return PictureVerdict::kBlack;
  if (std::ranges::any_of(meant, is_found) || last_right == found.digest)
    return PictureVerdict::kFrozen;
  return isTorn(meant, found.digest) ? PictureVerdict::kTorn : PictureVerdict::kForeign;
}

PictureVerdict SteadyVerdict::update(PictureVerdict reading) {
  const PictureVerdict before = std::exchange(last_, reading);
  const bool known = reading != PictureVerdict::kUnchecked;
  const bool agrees = isWrong(reading) == isWrong(current_);
  const bool twice = isWrong(reading) == isWrong(before) && before != PictureVerdict::kUnchecked;
  if (!known || agrees || twice) current_ = reading;
  return current_;
}

}  // namespace merlin::render::out
