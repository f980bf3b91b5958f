#include "daemon/base/simd.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "daemon/base/random.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;
using Eight = std::array<float, 8>;

struct Results {
  Eight sums, each, lesser;
  float least;
  std::int32_t whole;
  bool any;
  bool operator==(const Results&) const = default;
};

MERLIN_INLINE Results compute(const float* rows) {
  simd::Floats v[8];
  for (std::size_t k = 0; k < 8; ++k) v[k] = simd::load(rows + 8 * k);
  Results r{};
  simd::store(r.sums.data(), simd::sums(v));
  for (std::size_t k = 0; k < 8; ++k) r.each[k] = simd::sum(v[k]);
  simd::store(r.lesser.data(), simd::least(v[0] * v[1] + v[2], simd::greatest(v[3], v[4])));
  r.least = simd::leastLane(v[6])[5];
  r.whole = simd::sum(simd::toInts(100.0F * v[7]));
  r.any = simd::any(v[0] > 0.9F);
  return r;
}

Results computePlain(const float* rows) { return compute(rows); }
MERLIN_WIDE Results computeWide(const float* rows) { return compute(rows); }

TEST(Simd, WideAndPlainGiveTheSameBits) {
  Random random(1);
  for (int round = 0; round < 100; ++round) {
    std::array<float, 64> rows{};
    for (float& x : rows) x = static_cast<float>(random.uniform(-1, 1));
    const Results plain = computePlain(rows.data());
    EXPECT_EQ(simd::pick(computeWide, computePlain)(rows.data()), plain);
    EXPECT_EQ(plain.sums, plain.each);
  }
}

TEST(Simd, SumsHasTheSumOfEachVector) {
  std::array<float, 64> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<float>(i);
  const Results r = computePlain(rows.data());
  EXPECT_EQ(r.sums, (Eight{28, 92, 156, 220, 284, 348, 412, 476}));
  EXPECT_EQ(r.least, 48);
}

using Doubles = std::array<double, 4>;

template <std::size_t bytes>
MERLIN_INLINE Doubles addProducts(const double* a, const double* b) {
  using V = simd::Vector<double, bytes>;
  constexpr std::size_t kLanes = bytes / sizeof(double);
  Doubles out{};
  for (std::size_t i = 0; i < out.size(); i += kLanes) {
    V sum{};
    for (std::size_t k = 0; k < 20; ++k)
      sum = simd::addExact(sum, simd::loadAs<V>(a + 4 * k + i), b[k]);
    std::memcpy(&out[i], &sum, sizeof sum);
  }
  return out;
}

Doubles addPlain(const double* a, const double* b) { return addProducts<16>(a, b); }
MERLIN_WIDE Doubles addWide(const double* a, const double* b) { return addProducts<32>(a, b); }

TEST(Simd, ProductsOfFloatsAddUpToTheSameBits) {
  Random random(2);
  for (int round = 0; round < 100; ++round) {
    std::array<double, 80> a{};
    std::array<double, 20> b{};
    for (double& x : a) x = static_cast<double>(static_cast<float>(random.uniform(-1, 1)));
    for (double& x : b) x = static_cast<double>(static_cast<float>(random.uniform(-1, 1)));
    EXPECT_EQ(simd::pick(addWide, addPlain)(a.data(), b.data()), addPlain(a.data(), b.data()));
  }
}

using Numbers = std::array<std::uint32_t, 8>;

// Returns the expected result: the numbers at even positions of `from`, and 7 at odd positions,
// whose indices are out of bounds.
Numbers gatherPlain(const std::uint32_t* from) {
  return {from[0], 7, from[2], 7, from[4], 7, from[6], 7};
}
MERLIN_WIDE Numbers gatherWide(const std::uint32_t* from) {
  const simd::Ints even = (simd::kLane & 1) == 0;
  const simd::Ints index = even ? simd::kLane : simd::all(0x7FFFFFFF);
  Numbers out{};
  simd::store(out.data(), simd::gather(from, index, even, simd::all(7)));
  if (simd::anyWide(even & ~even) || !simd::anyWide(even)) out = {};
  return out;
}

TEST(Simd, GatherReadsOnlyWhatTheMaskSays) {
  const Numbers from = {10, 11, 12, 13, 14, 15, 16, 0xFFFFFFFF};
  EXPECT_EQ(simd::pick(gatherWide, gatherPlain)(from.data()), gatherPlain(from.data()));
}

// Only one header may depend on the processor; all other files use the vectors and pick() of that
// header.
TEST(Simd, OneHeaderKnowsTheProcessor) {
  const fs::path root = MERLIN_SOURCE_DIR;
  int files = 0;
  for (const char* top : {"daemon", "drivers", "nn", "render", "config"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const auto extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      if (entry.path() == root / "daemon/base/simd.h") continue;
      ++files;
      std::ifstream in(entry.path());
      const std::string text(std::istreambuf_iterator<char>(in), {});
      for (const char* word : {"__builtin_cpu_supports", "vector_size(", "intrin.h", "gnu::target"})
        EXPECT_EQ(text.find(word), std::string::npos) << entry.path() << ": " << word;
    }
  }
  EXPECT_GT(files, 100);
}

}  // namespace
}  // namespace merlin
