// The verdict on the picture that an output shows, compared with the picture that it was meant to
// show.
#include "render/out/picture/picture_judge.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace merlin::render::out {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Kind = FoundPicture::Kind;
using Pixels = std::vector<std::uint8_t>;

constexpr int kWidth = 200, kHeight = 96;
const Timestamp kNow{seconds(1000)};

// Returns a picture in which every pixel differs from its neighbours, and from the same pixel of
// the next frame.
Pixels picture(int frame) {
  Pixels pixels(static_cast<std::size_t>(kWidth * kHeight) * 4);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = static_cast<std::uint8_t>(static_cast<std::size_t>(frame) * 31 + i * 7 + i / 800);
  return pixels;
}

PictureDigest digest(const Pixels& pixels, PixelOrder order = PixelOrder::kRgba) {
  return digestOf({kWidth, kHeight, pixels, static_cast<std::size_t>(kWidth) * 4, order});
}

FoundPicture found(const Pixels& pixels) { return {Kind::kPixels, digest(pixels)}; }

TEST(PictureDigestTest, IsTheSameInEitherOrderOfBytes) {
  const Pixels rgba = picture(1);
  Pixels bgrx = rgba;
  for (std::size_t i = 0; i < bgrx.size(); i += 4) {
    std::swap(bgrx[i], bgrx[i + 2]);
    bgrx[i + 3] = 77;
  }
  EXPECT_EQ(digest(rgba), digest(bgrx, PixelOrder::kBgrx));
  EXPECT_NE(digest(rgba), digest(bgrx));
}

TEST(PictureDigestTest, LooksAtRowsPitchApart) {
  const Pixels whole = picture(1);
  const PixelRows part{kWidth / 2, kHeight / 2, whole, static_cast<std::size_t>(kWidth) * 4};
  Pixels cut;
  for (std::size_t y = 0; y < kHeight / 2; ++y) {
    const auto row = whole.begin() + static_cast<std::ptrdiff_t>(y * kWidth * 4);
    cut.insert(cut.end(), row, row + kWidth / 2 * 4);
  }
  EXPECT_EQ(digestOf(part),
            digestOf({kWidth / 2, kHeight / 2, cut, static_cast<std::size_t>(kWidth) / 2 * 4}));
}

TEST(PictureDigestTest, NoticesOnePixelOfARowThatIsReadAndTwoThatChangePlaces) {
  const Pixels before = picture(1);
  const std::size_t row = 2 * kWidth * 4;  // of 96 rows, row 2 is the first that is read
  Pixels pixels = before;
  pixels[row + 40] ^= 1U;
  EXPECT_NE(digest(pixels), digest(before));
  pixels = before;
  for (std::size_t c = 0; c < 3; ++c) std::swap(pixels[row + 40 + c], pixels[row + 44 + c]);
  EXPECT_NE(digest(pixels), digest(before));
  pixels = before;
  pixels[row - 4] ^= 1U;
  EXPECT_EQ(digest(pixels), digest(before)) << "a row that is not read";
}

TEST(PictureDigestTest, ReadsRowsThatAreEvenlySpreadOverThePicture) {
  const auto rows = digestRows(480);
  EXPECT_EQ(rows.size(), 24U);
  EXPECT_EQ(rows[0], 10);
  EXPECT_EQ(rows[1], 30);
  EXPECT_EQ(rows[23], 470);
  for (const int row : digestRows(1)) EXPECT_EQ(row, 0);
  Pixels pixels = picture(1);
  const PictureDigest before = digest(pixels);
  const auto read = digestRows(kHeight);
  for (int y = 0; y < kHeight; ++y) {
    if (std::ranges::find(read, y) == read.end())
      pixels[static_cast<std::size_t>(y * kWidth * 4)] ^= 1U;
  }
  EXPECT_EQ(digest(pixels), before) << "and no others";
}

TEST(PictureDigestTest, IsBlackBelowEightOfAnyChannel) {
  Pixels pixels(static_cast<std::size_t>(kWidth * kHeight) * 4, 7);
  for (std::size_t i = 3; i < pixels.size(); i += 4) pixels[i] = 255;  // opaque
  EXPECT_TRUE(digest(pixels).isBlack());
  pixels[2 * kWidth * 4 + 1] = 8;
  EXPECT_FALSE(digest(pixels).isBlack());
}

TEST(PictureDigestTest, PicturesSmallerThanItsCellsAndNone) {
  const Pixels pixels(4, 200);
  EXPECT_FALSE(digestOf({1, 1, pixels, 4}).isBlack());
  EXPECT_TRUE(digestOf({}).isBlack());
}

class PictureJudgeTest : public testing::Test {
 protected:
  // Notes that frame n was presented `ago` before now.
  void meant(int n, Duration ago) { meant_.push_back({digest(picture(n)), kNow - ago}); }
  PictureVerdict judge(const FoundPicture& f,
                       const std::optional<PictureDigest>& last_right = {}) const {
    return judgePicture(meant_, f, last_right, kNow);
  }
  std::vector<MeantPicture> meant_;
};

TEST_F(PictureJudgeTest, NothingMeantIsNothingToCompare) {
  EXPECT_EQ(judge(found(picture(1))), PictureVerdict::kUnchecked);
  EXPECT_EQ(judge({Kind::kForeign, {}}), PictureVerdict::kUnchecked);
}

TEST_F(PictureJudgeTest, TheNewestFrameIsRightHoweverLongItStands) {
  meant(1, seconds(9000));
  EXPECT_EQ(judge(found(picture(1))), PictureVerdict::kRight);
}

TEST_F(PictureJudgeTest, AFrameThatWasReplacedLatelyIsRightAndALongReplacedOneFrozen) {
  meant(1, milliseconds(3000));
  meant(2, milliseconds(1001));
  meant(3, milliseconds(999));
  meant(4, milliseconds(10));
  EXPECT_EQ(judge(found(picture(1))), PictureVerdict::kFrozen);
  EXPECT_EQ(judge(found(picture(2))), PictureVerdict::kRight) << "replaced 999 ms ago";
  EXPECT_EQ(judge(found(picture(3))), PictureVerdict::kRight);
  EXPECT_EQ(judge(found(picture(4))), PictureVerdict::kRight);
}

TEST_F(PictureJudgeTest, APictureThatWasRightOnceAndIsForgottenIsFrozen) {
  meant(50, seconds(2));
  const Pixels old = picture(1);
  EXPECT_EQ(judge(found(old), digest(old)), PictureVerdict::kFrozen);
  EXPECT_EQ(judge(found(old)), PictureVerdict::kForeign);
}

TEST_F(PictureJudgeTest, BlackIsWrongOnlyWhereSomethingWasMeant) {
  const Pixels black(static_cast<std::size_t>(kWidth * kHeight) * 4);
  meant(1, seconds(5));
  EXPECT_EQ(judge(found(black)), PictureVerdict::kBlack);
  EXPECT_EQ(judge({Kind::kOff, {}}), PictureVerdict::kBlack);
  meant_.push_back({digest(black), kNow - seconds(4)});
  EXPECT_EQ(judge(found(black)), PictureVerdict::kRight);
  EXPECT_EQ(judge({Kind::kOff, {}}), PictureVerdict::kRight);
  EXPECT_EQ(judge(found(picture(1))), PictureVerdict::kFrozen) << "a curtain that did not fall";
}

// The dimmed picture is the intended one; the earlier bright one is not.
TEST_F(PictureJudgeTest, ADimmedPictureIsRight) {
  Pixels dim = picture(1);
  for (std::uint8_t& channel : dim) channel = static_cast<std::uint8_t>(channel / 40);
  meant(1, seconds(9));
  meant_.push_back({digest(dim), kNow - seconds(3)});
  EXPECT_TRUE(digest(dim).isBlack());
  EXPECT_EQ(judge(found(dim)), PictureVerdict::kRight);
}

TEST_F(PictureJudgeTest, PartsOfTwoFramesAreTorn) {
  meant(1, milliseconds(40));
  meant(2, milliseconds(20));
  Pixels torn = picture(2);
  const Pixels older = picture(1);
  std::copy(older.begin() + kWidth * 4 * 40, older.end(), torn.begin() + kWidth * 4 * 40);
  EXPECT_EQ(judge(found(torn)), PictureVerdict::kTorn);
  torn[2 * kWidth * 4] ^= 1U;
  EXPECT_EQ(judge(found(torn)), PictureVerdict::kForeign) << "and a piece of neither";
}

TEST_F(PictureJudgeTest, AnotherBufferOrAnUnknownPictureIsForeign) {
  meant(1, seconds(5));
  EXPECT_EQ(judge({Kind::kForeign, digest(picture(1))}), PictureVerdict::kForeign);
  EXPECT_EQ(judge(found(picture(9))), PictureVerdict::kForeign);
}

TEST(SteadyVerdictTest, OneReadingThatDisagreesDoesNotCount) {
  SteadyVerdict v;
  EXPECT_EQ(v.update(PictureVerdict::kBlack), PictureVerdict::kUnchecked);
  EXPECT_TRUE(v.isUnsettled());
  EXPECT_EQ(v.update(PictureVerdict::kRight), PictureVerdict::kRight);
  EXPECT_FALSE(v.isUnsettled());
  EXPECT_EQ(v.update(PictureVerdict::kBlack), PictureVerdict::kRight);
  EXPECT_EQ(v.update(PictureVerdict::kRight), PictureVerdict::kRight);
  EXPECT_EQ(v.update(PictureVerdict::kTorn), PictureVerdict::kRight);
  EXPECT_TRUE(v.isUnsettled());
  EXPECT_EQ(v.update(PictureVerdict::kBlack), PictureVerdict::kBlack) << "wrong twice";
  EXPECT_EQ(v.update(PictureVerdict::kForeign), PictureVerdict::kForeign);
  EXPECT_EQ(v.update(PictureVerdict::kRight), PictureVerdict::kForeign);
  EXPECT_TRUE(v.isUnsettled());
  EXPECT_EQ(v.update(PictureVerdict::kRight), PictureVerdict::kRight);
}

TEST(SteadyVerdictTest, WhatCannotBeReadCountsAtOnce) {
  SteadyVerdict v;
  v.update(PictureVerdict::kBlack);
  v.update(PictureVerdict::kBlack);
  EXPECT_EQ(v.update(PictureVerdict::kUnchecked), PictureVerdict::kUnchecked);
  EXPECT_EQ(v.update(PictureVerdict::kBlack), PictureVerdict::kUnchecked) << "the first of two";
  EXPECT_EQ(v.update(PictureVerdict::kBlack), PictureVerdict::kBlack);
}

}  // namespace
}  // namespace merlin::render::out
