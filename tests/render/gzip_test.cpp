#include "render/mesh/io/gzip.h"

#include <gtest/gtest.h>

#include "tests/support/gzip.h"

namespace merlin::render::mesh {
namespace {

constexpr std::size_t kMost = std::size_t{1} << 24;

std::string numbers(int n) {
  std::string text;
  for (int i = 0; i < n; ++i) text += std::to_string(i * 7919 % 100'003) + " ";
  return text;
}

TEST(Gzip, UnpacksWhatWasPacked) {
  for (const std::string& text : {std::string("#Inventor V2.1 ascii\n"), numbers(100'000)}) {
    const std::string packed = test::gzipped(text);
    ASSERT_TRUE(isGzip(packed));
    const auto unpacked = gunzip(packed, kMost);
    ASSERT_TRUE(unpacked) << unpacked.error().what;
    EXPECT_EQ(*unpacked, text);
    EXPECT_EQ(gunzipBeginning(packed, 10), text.substr(0, 10));
  }
  const auto both = gunzip(test::gzipped("one ") + test::gzipped("two"), kMost);
  ASSERT_TRUE(both);
  EXPECT_EQ(*both, "one two");
  EXPECT_EQ(*gunzip(test::gzipped(""), kMost), "");
  EXPECT_EQ(*gunzip(test::gzipped("padded") + std::string(512, '\0'), kMost), "padded");
  EXPECT_FALSE(isGzip("#VRML V2.0 utf8"));
}

TEST(Gzip, RefusesABombAtTheLimit) {
  const std::string bomb = test::gzipped(std::string(kMost + 1, ' '));
  EXPECT_LT(bomb.size(), kMost / 500);
  const auto refused = gunzip(bomb, kMost);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kUnsupported);
  EXPECT_EQ(refused.error().what, "gzip: unpacks to more than 16777216 bytes");
  EXPECT_TRUE(gunzip(test::gzipped(std::string(kMost, ' ')), kMost));
  EXPECT_EQ(gunzipBeginning(bomb, 64), std::string(64, ' '));
}

TEST(Gzip, SaysThatAFileIsCutOrDamaged) {
  const std::string text = numbers(300), packed = test::gzipped(text);
  for (std::size_t n = 2; n < packed.size(); ++n) {
    const auto cut = gunzip(packed.substr(0, n), kMost);
    ASSERT_FALSE(cut) << n;
    EXPECT_EQ(cut.error().what, "gzip: is cut") << n;
    EXPECT_TRUE(text.starts_with(gunzipBeginning(packed.substr(0, n), 64))) << n;
  }
  std::size_t refused = 0;
  for (std::size_t i = 0; i < packed.size(); ++i) {
    std::string damaged = packed;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
    const auto read = gunzip(damaged, kMost);
    refused += !read;
    if (!read) continue;
    EXPECT_EQ(*read, text) << i << ": a byte of the header that says nothing";
  }
  EXPECT_GT(refused, packed.size() - 10);
}

TEST(Gzip, NamesThePlaceOfTheDamage) {
  std::string packed = test::gzipped(numbers(300));
  const std::string size = std::to_string(packed.size());
  const Error whole = packedFileError(packed);
  EXPECT_EQ(whole.code, Errc::kUnsupported);
  EXPECT_TRUE(whole.what.starts_with("is packed by gzip; ")) << whole.what;
  EXPECT_EQ(packedFileError(packed.substr(0, 40)).what, "gzip: is cut");
  // Damages the first byte of the CRC; the reader finds the error once it has read all of the CRC.
  packed[packed.size() - 8] ^= 1;
  const std::string why =
      "gzip: is damaged at byte " + std::to_string(packed.size() - 4) + " of " + size + ": ";
  EXPECT_EQ(packedFileError(packed).what, why + "incorrect data check");
  EXPECT_EQ(packedFileError(packed).code, Errc::kMalformed);
  EXPECT_EQ(gunzip(packed, kMost).error().what, why + "incorrect data check");
}

}  // namespace
}  // namespace merlin::render::mesh
