// Gives every file of corpus/ to its target, then the same files with random damage. A fault that
// libFuzzer once found is therefore detected if it recurs, in every build and with every sanitizer.
// Faults are crashes and sanitizer reports; a target aborts where a condition does not hold.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "daemon/base/random.h"
#include "tests/fuzz/targets.h"
#include "tests/support/extreme_length.h"

namespace merlin::fuzz {
namespace {

namespace fs = std::filesystem;
using Data = std::vector<std::uint8_t>;

constexpr int kDamaged = 1000;  // damaged inputs for each target, besides the files of the corpus

std::vector<Data> corpusOf(const Target& target) {
  std::vector<fs::path> paths;
  for (const auto& entry :
       fs::directory_iterator(fs::path(MERLIN_SOURCE_DIR) / "tests/fuzz/corpus" / target.name))
    paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<Data> all;
  for (const fs::path& path : paths) {
    std::ifstream in(path, std::ios::binary);
    all.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return all;
}

Data damaged(Data bytes, const Data& other, Random& random) {
  for (std::uint64_t i = 1 + random.below(4); i > 0 && !bytes.empty(); --i) {
    const auto at = static_cast<std::ptrdiff_t>(random.below(bytes.size()));
    const auto here = bytes.begin() + at;
    switch (random.below(7)) {
      case 0: *here ^= static_cast<std::uint8_t>(1U << random.below(8)); break;
      case 1: *here = static_cast<std::uint8_t>(random.below(2) == 0 ? 0xFF : random.next()); break;
      case 2: bytes.erase(here); break;
      case 3: bytes.insert(here, 1 + random.below(8), *here); break;
      case 4: bytes.resize(static_cast<std::size_t>(at)); break;
      case 5: test::writeExtremeLength(bytes, static_cast<std::size_t>(at), random); break;
      default: bytes.insert(here, other.begin(), other.end()); break;
    }
  }
  return bytes;
}

class Fuzz : public testing::TestWithParam<Target> {};

TEST_P(Fuzz, TheCorpusAndItsDamagedFilesHarmNothing) {
  const std::vector<Data> files = corpusOf(GetParam());
  ASSERT_FALSE(files.empty()) << "tests/fuzz/corpus/" << GetParam().name;
  for (const Data& file : files) GetParam().run(file);
  GetParam().run({});
  Random random(1);
  for (int i = 0; i < kDamaged; ++i) {
    const Data& other = files[random.below(files.size())];
    GetParam().run(damaged(files[random.below(files.size())], other, random));
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, Fuzz, testing::ValuesIn(targets().begin(), targets().end()),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace merlin::fuzz
