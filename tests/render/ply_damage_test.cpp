#include <string>

#include <gtest/gtest.h>

#include "tests/render/ply_files.h"

namespace merlin::render {
namespace {

using namespace std::string_literals;
using namespace test;  // ply_files.h

class PlyDamage : public testing::TestWithParam<Form> {};
INSTANTIATE_TEST_SUITE_P(Each, PlyDamage, testing::ValuesIn(kForms),
                         [](const auto& form) { return nameOf(form.param); });

TEST_P(PlyDamage, EveryTruncationIsAnError) {
  const std::string file = squareFile(GetParam());
  const std::size_t body = file.find("end_header\n") + 11;
  // Without its final line feed an ASCII file is still complete: the last number is "3".
  const std::size_t whole = file.size() - (GetParam() == Form::kAscii ? 1 : 0);
  for (std::size_t n = 0; n < whole; ++n) {
    const auto loaded = read(file.substr(0, n));
    ASSERT_FALSE(loaded) << n;
    const std::string& what = loaded.error().what;
    const bool half_a_number = GetParam() == Form::kAscii && n > 0 && file[n - 1] == '-';
    ASSERT_TRUE(n < body || what.starts_with("cut short") || half_a_number) << n << ": " << what;
  }
  EXPECT_TRUE(read(file.substr(0, whole)));
}

// With one wrong byte, a file is either refused with a reason or loaded as a valid mesh that is no
// larger than the file.
TEST_P(PlyDamage, OneWrongByteNeverLoadsHalf) {
  const std::string file = squareFile(GetParam());
  std::size_t refused = 0;
  for (std::size_t at = 0; at < file.size(); ++at) {
    std::string damaged = file;
    for (int value = 0; value < 256; ++value) {
      damaged[at] = static_cast<char>(value);
      const auto loaded = read(damaged);
      refused += !loaded;
      if (!loaded)
        EXPECT_FALSE(loaded.error().what.empty());
      else
        EXPECT_LE(loaded->mesh.vertexCount() + loaded->mesh.triangleCount(), file.size());
    }
  }
  EXPECT_GT(refused, 100 * file.size());
}

// A fault of the ASCII file above: `from` is replaced by `to`, which gives this error.
struct Fault {
  const char* name;
  const char* from;
  const char* to;
  const char* error;

  friend void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }
};

class PlyFaults : public testing::TestWithParam<Fault> {};

TEST_P(PlyFaults, AreNamedWithTheirPlace) {
  const auto loaded = read(replaced(squareFile(Form::kAscii), GetParam().from, GetParam().to));
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().what, GetParam().error);
  EXPECT_EQ(loaded.error().code, Errc::kMalformed);
}

constexpr const char* kFormat =
    "line 2: a format is ascii, binary_little_endian or binary_big_endian, version 1.0";
constexpr const char* kElement = "line 4: an element has a name and a count: \"element vertex 8\"";
constexpr const char* kProperty =
    "line 5: a property is \"property TYPE NAME\" or \"property list TYPE TYPE NAME\"";

INSTANTIATE_TEST_SUITE_P(
    Header, PlyFaults,
    testing::Values(
        Fault{"no magic", "ply\n", "plx\n", "line 1: a PLY file starts with \"ply\""},
        Fault{"no format", "format ascii 1.0\n", "", "line 13: the header has no format line"},
        Fault{"other version", "ascii 1.0", "ascii 1.1", kFormat},
        Fault{"other form", "ascii 1.0", "ebcdic 1.0", kFormat},
        Fault{"unknown keyword", "element vertex", "elements vertex",
              "line 4: \"elements\" is not a keyword of a PLY header"},
        Fault{"no count", "vertex 4", "vertex", kElement},
        Fault{"negative count", "vertex 4", "vertex -4", kElement},
        Fault{"fractional count", "vertex 4", "vertex 4.5", kElement},
        Fault{"count beyond 64 bits", "vertex 4", "vertex 18446744073709551616", kElement},
        Fault{"property first", "element vertex 4\n", "", "line 4: a property before any element"},
        Fault{"unknown type", "float x", "quad x", kProperty},
        Fault{"no type", "float x", "x", kProperty},
        Fault{"too many words", "float x", "float x y", kProperty},
        Fault{"list of lists", "float x", "list uchar list x", kProperty},
        Fault{"fractional length", "list uchar", "list float",
              "line 13: the length of a list must be an integer"},
        Fault{"no end", "end_header", "end_heaven",
              "line 14: \"end_heaven\" is not a keyword of a PLY header"},
        Fault{"missing x", "float x", "float q", "the vertices lack x, y or z"},
        Fault{"x as a list", "float x", "list uchar float x", "the vertices lack x, y or z"},
        Fault{"x twice", "float z", "float x", "the vertices lack x, y or z"},
        Fault{"two vertex elements", "element face 2", "element vertex 2", "two vertex elements"}));

INSTANTIATE_TEST_SUITE_P(
    Body, PlyFaults,
    testing::Values(Fault{"a word", "0.000000 1.000000 0.5", "0.000000 one 0.5",
                          "vertex 2, property y: \"one\" is not a number"},
                    Fault{"two numbers in one", "0.000000 1.000000 0.5", "0.000000 1.0.0 0.5",
                          "vertex 2, property y: \"1.0.0\" is not a number"},
                    Fault{"hexadecimal", "0.000000 1.000000 0.5", "0.000000 0x1 0.5",
                          "vertex 2, property y: \"0x1\" is not a number"},
                    Fault{"beyond a double", "0.000000 1.000000 0.5", "0.000000 1e999 0.5",
                          "vertex 2, property y: \"1e999\" is not a number"},
                    Fault{"beyond a float", "0.000000 1.000000 0.5", "0.000000 1e99 0.5",
                          "vertex 2: coordinate y is inf; the limit is +-1e+18"},
                    Fault{"not a number", "0.000000 1.000000 0.5", "0.000000 nan 0.5",
                          "vertex 2: coordinate y is nan; the limit is +-1e+18"},
                    Fault{"infinite", "0.000000 1.000000 0.5", "-inf 1.000000 0.5",
                          "vertex 2: coordinate x is -inf; the limit is +-1e+18"},
                    Fault{"feature not a number", "-0.500000", "nan",
                          "feature heat: vertex 2 has nan"},
                    Fault{"one row too few", "vertex 4", "vertex 5",
                          "cut short in face 1 of 2, property vertex_indices"},
                    Fault{"one face too many", "face 2", "face 3",
                          "cut short in face 2 of 3, property vertex_indices"},
                    Fault{"corner beyond", "3 0 1 3", "3 0 1 4",
                          "triangle 2: there is no vertex 4, the mesh has 4 (0 to 3)"},
                    Fault{"negative corner", "3 0 1 3", "3 0 -1 3",
                          "face 1: corner 1 is -1, not a vertex index"},
                    Fault{"fractional corner", "3 0 1 3", "3 0.5 1 3",
                          "face 1: corner 0 is 0.5, not a vertex index"},
                    Fault{"corner beyond 31 bits", "3 0 1 3", "3 0 1 2147483648",
                          "face 1: corner 2 is 2147483648, not a vertex index"},
                    Fault{"corner not a number", "3 0 1 3", "3 0 nan 3",
                          "face 1: corner 1 is nan, not a vertex index"},
                    Fault{"endless list", "3 0 1 3", "4000000000 0 1 3",
                          "cut short in face 1 of 2, property vertex_indices"},
                    Fault{"negative length", "3 0 1 3", "-3 0 1 3",
                          "face 1, property vertex_indices: -3 is not the length of a list"},
                    Fault{"fractional length", "3 0 1 3", "2.5 0 1 3",
                          "face 1, property vertex_indices: 2.5 is not the length of a list"},
                    Fault{"length not a number", "3 0 1 3", "nan 0 1 3",
                          "face 1, property vertex_indices: nan is not the length of a list"}));

// The reader must not allocate memory for more elements than the file can hold; these would take 48
// GB or more.
TEST(PlyCounts, BeyondTheFilesSizeAreRefusedFirst) {
  for (const Form form : kForms) {
    for (const char* count : {"4000000000", "18446744073709551615", "6148914691236517206"}) {
      for (const char* element : {"vertex", "face"}) {
        const std::string file = squareFile(form);
        const std::string mine = element + (element == "face"s ? " 2"s : " 4"s);
        const auto loaded = read(replaced(file, mine, element + " "s + count));
        ASSERT_FALSE(loaded) << element << " " << count;
        EXPECT_EQ(loaded.error().code, Errc::kMalformed);
        EXPECT_TRUE(loaded.error().what.starts_with("cut short: the header declares "s + count +
                                                    " x " + element + ", the file ends after "))
            << loaded.error().what;
      }
    }
  }
}

TEST(PlyCounts, OfAnElementWithoutPropertiesCostNothing) {
  const auto loaded =
      read("ply\nformat ascii 1.0\nelement nothing 18446744073709551615\nend_header\n");
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->mesh.vertexCount(), 0u);
}

TEST(PlyHeader, OfSixtyFourKilobytesIsNone) {
  std::string file = "ply\n";
  for (int line = 0; line < 10000; ++line) file += "comment\n";
  const auto loaded = read(file + squareFile(Form::kAscii).substr(4));
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().what, "line 8193: the header has no end_header");
}

}  // namespace
}  // namespace merlin::render
