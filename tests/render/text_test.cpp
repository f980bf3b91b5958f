// Text as pixels: where it is drawn, and that no bytes can make it draw outside of its box.
#include "render/text/text.h"

#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/utf8.h"
#include "render/text/font_file.h"

namespace merlin::render::text {
namespace {

constexpr int kSizes[] = {13, 20};
constexpr Colour kWhite{255, 255, 255};

const GlyphAtlas& atlas() {
  static const GlyphAtlas made = *GlyphAtlas::make(fontFile(), kSizes);
  return made;
}
Font font(std::size_t size = 0) { return {&atlas(), size}; }

// An image of transparent pixels, to draw on.
struct Picture {
  explicit Picture(int w = 200, int h = 60)
      : width(w), height(h), rgba(std::size_t{4} * static_cast<std::size_t>(w * h)) {}

  Surface surface() { return {rgba, width, height}; }
  std::uint8_t alpha(int x, int y) const {
    return rgba[static_cast<std::size_t>(4 * (y * width + x) + 3)];
  }
  // Returns the smallest rectangle that contains all drawn pixels.
  Rect drawn() const {
    int left = width, top = height, right = 0, bottom = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (alpha(x, y) == 0) continue;
        left = std::min(left, x), top = std::min(top, y);
        right = std::max(right, x + 1), bottom = std::max(bottom, y + 1);
      }
    }
    return right == 0 ? Rect{} : Rect{left, top, right - left, bottom - top};
  }
  bool isInside(const Rect& r) const { return drawn() == Rect{} || common(drawn(), r) == drawn(); }

  int width, height;
  std::vector<std::uint8_t> rgba;
};

std::u32string decoded(std::string_view text) {
  std::u32string characters;
  while (!text.empty()) characters += takeCharacter(text);
  return characters;
}

TEST(Text, ACapitalStandsOnTheBaseLineAndIsAboutThreeQuartersOfTheEmHigh) {
  Picture picture;
  const Point end = drawText(picture.surface(), font(1), {10, 40}, "H", kWhite);
  const Rect drawn = picture.drawn();
  EXPECT_EQ(drawn.y + drawn.height, 40);
  EXPECT_NEAR(drawn.height, 15, 1);  // DejaVu's capitals: 0.729 em
  EXPECT_GE(drawn.x, 10);
  EXPECT_EQ(end.x - 10, textWidth(font(1), "H"));
  EXPECT_NEAR(end.x - 10, 15, 1);  // 0.752 em
}

TEST(Text, EdgesAreSmoothAndStemsAreOpaque) {
  Picture picture;
  drawText(picture.surface(), font(1), {10, 40}, "Hello", kWhite);
  int whole = 0, partial = 0;
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) {
    whole += picture.rgba[i] == 255;
    partial += picture.rgba[i] > 0 && picture.rgba[i] < 255;
  }
  EXPECT_GT(whole, 20);
  EXPECT_GT(partial, 20);
}

TEST(Text, AWidthIsTheSumOfItsParts) {
  EXPECT_EQ(textWidth(font(), ""), 0);
  EXPECT_EQ(textWidth(font(), "rate") + textWidth(font(), " 30"), textWidth(font(), "rate 30"));
  EXPECT_GT(textWidth(font(1), "rate"), textWidth(font(), "rate"));
}

TEST(Text, NothingIsDrawnOutsideItsBox) {
  for (const Rect box : {Rect{20, 10, 50, 20}, Rect{150, 40, 50, 20}, Rect{0, 0, 7, 9},
                         Rect{20, 20, 30, 4}, Rect{20, 20, 0, 20}}) {
    for (const Align align : {Align::kLeft, Align::kMiddle, Align::kRight}) {
      Picture picture;
      const int width =
          drawTextIn(picture.surface(), font(1), box, "Ägypten, (jq) ", kWhite, align);
      EXPECT_TRUE(picture.isInside(box)) << box.x << ' ' << box.width;
      EXPECT_LE(width, std::max(box.width, textWidth(font(1), "\u2026")));
    }
  }
}

TEST(Text, ATextBeyondTheSurfaceIsNotDrawn) {
  for (const Point pen : {Point{-5000, 30}, Point{5000, 30}, Point{10, -100}, Point{10, 500}}) {
    Picture picture;
    drawText(picture.surface(), font(), pen, "outside", kWhite);
    EXPECT_EQ(picture.drawn(), Rect{});
  }
  Picture cut;
  drawText(cut.surface(), font(1), {-6, 14}, "MMMMMMMMMMMMMMMMMMMMMMMMMMM", kWhite);
  EXPECT_EQ(cut.drawn().x, 0);
  EXPECT_EQ(cut.drawn().width, cut.width);
}

TEST(Text, ATextThatIsTooWideEndsWithAnEllipsis) {
  Picture cut, whole;
  const Rect box{10, 10, 60, 20};
  drawTextIn(cut.surface(), font(), box, "ankylosaurus of the museum", kWhite);
  const int width = drawTextIn(whole.surface(), font(), box, "ankylos\u2026", kWhite);
  EXPECT_LE(width, 60);
  EXPECT_EQ(cut.rgba, whole.rgba);
}

TEST(Text, ACharacterThatTheFontLacksIsABox) {
  EXPECT_FALSE(atlas().has(0x6F22));  // Chinese
  Picture picture;
  drawText(picture.surface(), font(1), {10, 40}, "\u6f22", kWhite);
  const Rect box = picture.drawn();
  EXPECT_EQ(box, (Rect{11, 25, 10, 15}));
  EXPECT_EQ(picture.alpha(box.x, box.y), 255);
  EXPECT_EQ(picture.alpha(box.x + box.width - 1, box.y + box.height - 1), 255);
  EXPECT_EQ(picture.alpha(box.x + 4, box.y + 7), 0);  // the box is empty inside
}

TEST(Text, LatinGreekCyrillicAndSignsHaveGlyphs) {
  for (const char32_t c : decoded("AzÄßéñçşřŁ€µ°±×λΩЖя…–—‘’“”•→≤≥●■▲"))
    EXPECT_TRUE(atlas().has(c)) << std::hex << static_cast<std::uint32_t>(c);
}

TEST(Text, EachByteThatIsNotUtf8IsOneUnknownCharacter) {
  EXPECT_EQ(decoded("a\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80"), U"aä€😀");
  EXPECT_EQ(decoded("\xC3"), U"\uFFFD");            // cut
  EXPECT_EQ(decoded("\xE2\x82"), U"\uFFFD\uFFFD");  // cut
  // The character is cut in the middle of a longer text: the bytes behind the text's end must not
  // be read.
  EXPECT_EQ(decoded(std::string_view("\xE2\x82\xAC", 2)), U"\uFFFD\uFFFD");
  EXPECT_EQ(decoded("\xC3(x"), U"\uFFFD(x");                  // no continuation byte
  EXPECT_EQ(decoded("\x80\xBF"), U"\uFFFD\uFFFD");            // a continuation byte alone
  EXPECT_EQ(decoded("\xC0\x80"), U"\uFFFD\uFFFD");            // overlong
  EXPECT_EQ(decoded("\xE0\x80\xAF"), U"\uFFFD\uFFFD\uFFFD");  // overlong
  EXPECT_EQ(decoded("\xED\xA0\x80"), U"\uFFFD\uFFFD\uFFFD");  // surrogate
  EXPECT_EQ(decoded("\xF4\x90\x80\x80").front(), U'\uFFFD');  // above U+10FFFF
  EXPECT_EQ(decoded("\xFF\xFE"), U"\uFFFD\uFFFD");
}

// Each text is in a buffer of exactly its size, so that a sanitizer detects a read beyond its end.
TEST(Text, AnyBytesAreDrawnInsideTheirBox) {
  std::minstd_rand random(7);
  for (int i = 0; i < 3000; ++i) {
    std::vector<char> bytes(random() % 12);
    for (char& byte : bytes)
      byte = static_cast<char>(random() % 3 ? 0xC0 + random() % 64 : random());
    const std::string_view text(bytes.data(), bytes.size());
    Picture picture(60, 30);
    const Rect box{5, 5, 45, 20};
    drawTextIn(picture.surface(), font(), box, text, kWhite);
    ASSERT_TRUE(picture.isInside(box)) << i;
    const std::u32string characters = decoded(text);
    ASSERT_LE(characters.size(), bytes.size());
  }
}

TEST(Text, AVeryLongTextIsMeasuredAndDrawn) {
  const std::string longest(5'000'000, 'W');
  EXPECT_GE(textWidth(font(), longest), 1'000'000);
  Picture picture;
  EXPECT_LE(drawTextIn(picture.surface(), font(), {0, 0, 200, 60}, longest, kWhite), 200);
}

TEST(Text, AColourGoesOverWhatIsThere) {
  Picture picture(4, 1);
  picture.surface().fill({0, 0, 4, 1}, {10, 20, 30});
  picture.surface().fill({1, 0, 1, 1}, {255, 255, 255, 128});
  picture.surface().fill({2, 0, 1, 1}, {255, 0, 0});
  const std::vector<std::uint8_t> wanted = {10,  20, 30, 255, 133, 138, 143, 255,
                                            255, 0,  0,  255, 10,  20,  30,  255};
  EXPECT_EQ(picture.rgba, wanted);
}

TEST(GlyphAtlas, ASecondOneHasTheSameBytes) {
  const GlyphAtlas second = *GlyphAtlas::make(fontFile(), kSizes);
  Picture one, two;
  drawText(one.surface(), font(), {3, 30}, "The same, Ж", kWhite);
  drawText(two.surface(), {&second, 0}, {3, 30}, "The same, Ж", kWhite);
  EXPECT_EQ(one.rgba, two.rgba);
  EXPECT_NE(one.drawn(), Rect{});
}

TEST(GlyphAtlas, AFileThatIsNoFontIsRefused) {
  const std::vector<std::byte> zeros(1000);
  const auto made = GlyphAtlas::make(zeros, kSizes);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().code, Errc::kMalformed);
  EXPECT_NE(made.error().what.find("the font of 1000 bytes cannot be read"), std::string::npos);
}

TEST(GlyphAtlas, TheFontThatShipsIsTheFileInTheSources) {
  EXPECT_EQ(fontFile().size(), 759'720U);
  EXPECT_EQ(fontFile()[1], std::byte{1});  // TrueType: 00 01 00 00
}

}  // namespace
}  // namespace merlin::render::text
