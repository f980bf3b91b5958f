#include <cmath>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "nn/io/network_file.h"
#include "tests/nn/files.h"
#include "tests/nn/shipped.h"

namespace merlin::nn {
namespace {

using test::contentOf;

const std::string& shippedText() {
  static const std::string text = contentOf(test::kShippedPath);
  return text;
}

// Returns the text of the shipped file with `from` replaced by `to`.
std::string changed(std::string_view from, std::string_view to) {
  std::string text = shippedText();
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

PostureNetwork randomNetwork(std::uint64_t seed) {
  PostureNetwork network;
  network.phi = Phi::kAtan;
  Random random(seed);
  const auto fill = [&](auto& rows) {
    for (auto& row : rows) {
      for (float& w : row)
        w = static_cast<float>(std::exp(random.uniform(-12, 12)) * random.normal());
    }
  };
  fill(network.weights.hidden);
  fill(network.weights.output);
  for (InputRange& r : network.ranges) {
    r = {static_cast<float>(random.uniform(-3, 0)), static_cast<float>(random.uniform(0.1, 3))};
  }
  for (std::uint32_t code = 0; code < kCodes; ++code) {
    EXPECT_TRUE(network.postures.add(code, "posture_" + std::to_string(code)));
  }
  return network;
}

void expectSameBits(const PostureNetwork& a, const PostureNetwork& b) {
  EXPECT_EQ(a.phi, b.phi);
  EXPECT_EQ(a.weights.hidden, b.weights.hidden);
  EXPECT_EQ(a.weights.output, b.weights.output);
  for (std::size_t i = 0; i < kInputs; ++i) {
    EXPECT_EQ(a.ranges[i].low, b.ranges[i].low);
    EXPECT_EQ(a.ranges[i].high, b.ranges[i].high);
  }
  for (std::uint32_t c = 0; c < kCodes; ++c) EXPECT_EQ(a.postures.name(c), b.postures.name(c));
}

using NetworkFiles = test::FilesTest;

TEST(NetworkFormat, IsItsOwnInverse) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const PostureNetwork network = randomNetwork(seed);
    const Provenance trained{"by \"hand\"\n", ~std::uint64_t{0}, 7, 0.1 + 0.2, seed % 2 == 0};
    const std::string text = formatNetwork({network, trained, {}});
    const auto read = parseNetwork(text, "f");
    ASSERT_TRUE(read) << read.error().what;
    expectSameBits(read->network, network);
    EXPECT_EQ(read->trained.how, trained.how);
    EXPECT_EQ(read->trained.seed, trained.seed);
    EXPECT_EQ(read->trained.samples, trained.samples);
    EXPECT_EQ(read->trained.mse, trained.mse);
    EXPECT_EQ(read->trained.synthetic, trained.synthetic);
    EXPECT_EQ(formatNetwork(*read), text);
  }
}

TEST(NetworkFormat, HoldsTheShippedFile) {  // the format is a contract: nn/io/README.md
  const auto file = loadNetwork(test::kShippedPath);
  ASSERT_TRUE(file) << file.error().what;
  EXPECT_EQ(formatNetwork(*file), shippedText());
  EXPECT_EQ(file->network.postures.name(0b01010), "fist");
  EXPECT_EQ(file->trained.seed, 1998u);
  EXPECT_EQ(file->trained.samples, 1600u);
  EXPECT_TRUE(file->trained.synthetic);
}

TEST(NetworkDamage, EveryTruncationIsAnError) {
  const std::string& text = shippedText();
  ASSERT_GT(text.size(), 6000u);
  // Prefixes end before the last byte, since the file without that byte, a line feed, is still
  // valid.
  for (std::size_t n = 0; n + 1 < text.size(); n += 11) {
    const auto read = parseNetwork(std::string_view(text).substr(0, n), "f");
    ASSERT_FALSE(read) << n;
    ASSERT_TRUE(read.error().what.starts_with("f: ")) << read.error().what;
  }
}

// A file with one wrong byte must either be refused, or load as a complete network with valid
// numbers.
TEST(NetworkDamage, OneWrongByteNeverLoadsHalf) {
  std::size_t refused = 0;
  std::string text = shippedText();
  for (std::size_t at = 0; at < text.size(); at += 23) {
    const char kept = text[at];
    for (const char c : {'\0', '"', '}', '9', '-', '\xFF'}) {
      text[at] = c;
      const auto read = parseNetwork(text, "f");
      refused += !read;
      if (!read) continue;
      ASSERT_EQ(read->network.postures.size(), 8u) << at;
      const auto again = parseNetwork(formatNetwork(*read), "f");
      ASSERT_TRUE(again) << at << ": " << again.error().what;
      expectSameBits(again->network, read->network);
    }
    text[at] = kept;
  }
  EXPECT_GT(refused, text.size() / 12);  // at least a third of the damaged files that were tried
}

struct Fault {
  const char* from;
  const char* to;
  const char* error;
};

// Prints only the place of the fault, from which CTest makes the test's name.
void PrintTo(const Fault& fault, std::ostream* out) {
  const std::string_view error = fault.error;
  *out << error.substr(8, error.find_first_of(":\"", 8) - 8);
}

class NetworkFaults : public testing::TestWithParam<Fault> {};

TEST_P(NetworkFaults, AreNamedWithPlaceFoundAndAllowed) {
  const auto read = parseNetwork(changed(GetParam().from, GetParam().to), "f.json");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().what, GetParam().error);
}

INSTANTIATE_TEST_SUITE_P(
    Each, NetworkFaults,
    testing::Values(
        Fault{
            "\"version\": 2", "\"version\": 3",
            "f.json: /version: found 3; allowed: 2, the version that this release of MERLIN reads"},
        Fault{"\"version\": 2", "\"version\": \"1\"",
              "f.json: /version: found \"1\"; allowed: an integer from 0 to 1000"},
        Fault{"\"version\": 2,", "",
              "f.json: /version: found nothing; allowed: a value: the key is missing"},
        Fault{"\"inputs\": 23", "\"inputs\": 22", "f.json: /sizes/inputs: found 22; allowed: 23"},
        Fault{"\"hidden\": 15", "\"hidden\": 15.5",
              "f.json: /sizes/hidden: found 15.5; allowed: 15"},
        Fault{"\"phi\": \"sigmoid\"", "\"phi\": \"tanh\"",
              "f.json: /phi: found \"tanh\"; allowed: \"sigmoid\", \"signum\" or \"atan\""},
        Fault{"\"phi\"", "\"fi/~\"",
              "f.json: (root): found the key \"fi/~\"; allowed: version, sizes, phi, unit, inputs, "
              "hidden, output, postures, memory, trained"},
        Fault{"\"phi\"", "\"fi/~\": [0, 1e999], \"phi\"",
              "f.json: line 4: number overflow parsing '1e999'"},
        Fault{"\"slot\": 1,", "\"slot\": 2,", "f.json: /inputs/1/slot: found 2; allowed: 1"},
        Fault{"\"thumb-mcp\"", "\"thumb-ip\"",
              "f.json: /inputs/1/name: found \"thumb-ip\"; allowed: \"thumb-mcp\""},
        Fault{"\"hidden\": [\n    [", "\"hidden\": [\n    [0, ",
              "f.json: /hidden/0: found an array of 25 elements; allowed: an array of 24 elements"},
        Fault{"\"output\": [\n", "\"output\": [\n[],",
              "f.json: /output: found an array of 6 elements; allowed: an array of 5 elements"},
        Fault{"\"output\": [\n    [", "\"output\": [\n    [null, ",
              "f.json: /output/0: found an array of 17 elements; allowed: an array of 16 elements"},
        Fault{"\"hidden\": [\n    [", "\"hidden\": [\n    [1e7], [",
              "f.json: /hidden: found an array of 16 elements; allowed: an array of 15 elements"},
        Fault{"\"00011\"", "\"0011\"",
              "f.json: /postures/0/code: found \"0011\"; allowed: five digits 0 or 1, output 4 "
              "first"},
        Fault{"\"unit\": \"rad\"", "\"unit\": \"deg\"",
              "f.json: /unit: found \"deg\"; allowed: \"rad\" or \"raw\""},
        Fault{"\"name\": \"horns\"", "\"nam\": \"horns\"",
              "f.json: /postures/7: found the key \"nam\"; allowed: code, name"},
        Fault{
            "\"seed\": 1998", "\"seed\": -1",
            "f.json: /trained/seed: found -1; allowed: an integer from 0 to 18446744073709551615"},
        Fault{"\"synthetic\": true", "\"synthetic\": 1",
              "f.json: /trained/synthetic: found 1; allowed: true or false"},
        Fault{"\"seed\": 1998", "\"seed\": 1998, \"seed\": 1998",
              "f.json: line 101: duplicate key \"seed\" in one object, first on line 101"}));

// These numbers are out of range, or JSON, double or float cannot represent them. Each takes the
// place of the first weight.
TEST(NetworkHostile, NumbersThatAreNone) {
  const std::string& text = shippedText();
  const auto row = text.find("\"hidden\": [\n    [") + 17;
  const auto end = text.find(',', row);
  ASSERT_LT(end, text.size());
  for (const char* number : {"NaN", "Infinity", "-inf", "1e999", "-1e999", "1e38", "1000001",
                             "0x10", "01", ".5", "\"1\"", "null", "true", "[]", "{}", ""}) {
    std::string damaged = text;
    damaged.replace(row, end - row, number);
    const auto read = parseNetwork(damaged, "f");
    ASSERT_FALSE(read) << number;
    const std::string& what = read.error().what;
    const bool syntax = what.starts_with("f: line ");
    EXPECT_TRUE(syntax || what.starts_with("f: /hidden/0/")) << what;
    EXPECT_TRUE(syntax || what.find("; allowed: ") != std::string::npos) << what;
  }
}

TEST(NetworkHostile, DepthAndSizeAreBounded) {
  for (const std::size_t depth : {33U, 1000U, 500000U}) {
    const auto read = parseNetwork(std::string(depth, '['), "f");
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().what, "f: line 1: more than 32 levels deep");
  }
  const auto nested =
      parseNetwork(changed("\"phi\": \"sigmoid\"", "\"phi\": [[[[[[[[1]]]]]]]]"), "f");
  ASSERT_FALSE(nested);
  EXPECT_EQ(nested.error().what,
            "f: /phi: found an array of 1 elements; allowed: a string of at most 19 characters");
  const auto large = parseNetwork(std::string((1 << 20) + 1, ' '), "f");
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().what, "f: line 1: 1048577 bytes; at most 1048576 are allowed");
}

TEST(NetworkHostile, OtherDocuments) {
  for (const char* text :
       {"", " ", "null", "[]", "{}", "\"\xFF\"", "\xEF\xBB\xBF{}", "{\"version\": 2}"}) {
    const auto read = parseNetwork(text, "f");
    ASSERT_FALSE(read) << text;
    EXPECT_TRUE(read.error().what.starts_with("f: ")) << read.error().what;
  }
  EXPECT_EQ(parseNetwork(shippedText() + "{}", "f").error().code, Errc::kMalformed);
  EXPECT_EQ(parseNetwork(changed("\"version\": 2", "\"version\": 9"), "f").error().code,
            Errc::kUnsupported);
}

TEST_F(NetworkFiles, AreReplacedWholeOrNotAtAll) {
  const auto shipped = loadNetwork(test::kShippedPath);
  ASSERT_TRUE(shipped);
  const std::string file = path("net.json");
  ASSERT_TRUE(saveNetwork(file, *shipped));
  EXPECT_EQ(contentOf(file), shippedText());

  PostureNetwork bad = shipped->network;
  bad.weights.output[4][15] = std::numeric_limits<float>::quiet_NaN();
  const auto refused = saveNetwork(file, {bad, shipped->trained, {}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kInvalidArgument);
  EXPECT_TRUE(refused.error().what.starts_with("not written: " + file + ": line 53: syntax error"))
      << refused.error().what;
  EXPECT_EQ(contentOf(file), shippedText());

  ASSERT_TRUE(saveNetwork(file, {randomNetwork(1), {}, {}}));
  EXPECT_EQ(contentOf(file), formatNetwork({randomNetwork(1), {}, {}}));
  EXPECT_EQ(count(), 1u);  // no temporary file is left
}

TEST_F(NetworkFiles, ThatAreNotThereOrNoFilesAreErrors) {
  EXPECT_EQ(loadNetwork(path("none.json")).error().code, Errc::kNotFound);
  EXPECT_EQ(loadNetwork(folder_.string()).error().code, Errc::kMalformed);
  EXPECT_FALSE(saveNetwork(path("none/net.json"), {randomNetwork(1), {}, {}}));
  std::ofstream(path("empty.json")).flush();
  EXPECT_EQ(loadNetwork(path("empty.json")).error().code, Errc::kMalformed);
}

}  // namespace
}  // namespace merlin::nn
