// Compares what an output was found to show with what it was meant to show. Pure: times are passed
// in.
#pragma once

#include <optional>
#include <span>

#include "daemon/base/clock.h"
#include "render/out/picture/picture_digest.h"

namespace merlin::render::out {

// In the order of kPictureVerdictNames, and of shm::OutputStats::picture.
enum class PictureVerdict {
  kUnchecked,  // nothing was read back
  kRight,
  kBlack,    // black or switched off, although no black frame was meant
  kFrozen,   // an older frame, although newer ones were handed over long ago
  kTorn,     // parts of two frames
  kForeign,  // another program's picture, or one that the wall never made
};
inline constexpr const char* kPictureVerdictNames[] = {"unchecked", "right", "black",
                                                       "frozen",    "torn",  "foreign"};
inline constexpr const char* nameOf(PictureVerdict verdict) {
  return kPictureVerdictNames[static_cast<int>(verdict)];
}
inline constexpr bool isWrong(PictureVerdict verdict) {
  return verdict != PictureVerdict::kUnchecked && verdict != PictureVerdict::kRight;
}

// A frame that an output was handed.
struct MeantPicture {
  PictureDigest digest{};
  Timestamp handed_over{};
};

// What an output was found to show.
struct FoundPicture {
  enum class Kind {
    kPixels,   // `digest` is what was read
    kOff,      // the display is sent no picture
    kForeign,  // a buffer that is not the wall's
  };
  Kind kind = Kind::kPixels;
  PictureDigest digest{};
};

// An output may still show a frame this long after the next one was handed over.
inline constexpr Duration kLongestLag = std::chrono::seconds(1);

// Judges what a display was found to show. `meant`: the last frames that its output was handed,
// oldest first, each different from the one before. `last_right`: the digest that was found when
// the verdict was last kRight. `began`: when the reading began. Returns kUnchecked if `meant` is
// empty. Cost: at most one comparison of digests for each pair of frames in `meant`.
PictureVerdict judgePicture(std::span<const MeantPicture> meant, const FoundPicture& found,
                            const std::optional<PictureDigest>& last_right, Timestamp began);

// Debounces verdicts: the current one changes between right and wrong only after two readings in a
// row that agree on this, whichever faults they name. kUnchecked takes effect at once.
class SteadyVerdict {
 public:
  PictureVerdict update(PictureVerdict reading);
  PictureVerdict current() const noexcept { return current_; }
  // Returns true if the last reading disagrees with current(), so that the next reading should
  // follow soon.
  bool isUnsettled() const noexcept { return isWrong(last_) != isWrong(current_); }

 private:
  PictureVerdict current_ = PictureVerdict::kUnchecked, last_ = PictureVerdict::kUnchecked;
};

}  // namespace merlin::render::out
