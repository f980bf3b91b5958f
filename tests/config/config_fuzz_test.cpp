// Mutated configurations: none crashes the loader, and none is accepted with a key that is ignored.
// ./dev bench fuzz-config does the same with a hundred thousand configurations.
#include "tests/bench/config_fuzz.h"

#include <array>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "config/writer.h"
#include "tests/support/temp_dir.h"

namespace merlin::bench {
namespace {

using Outcome = ConfigFuzz::Outcome;

std::vector<std::string> examples() {
  std::vector<std::string> all = {settingsText(Settings{})};
  for (const char* name :
       {"demo", "installed", "wall", "wall-kms-four", "wall-flat-overlap", "wall-stereo"}) {
    all.push_back(test::readText(std::string(MERLIN_SOURCE_DIR "/config/") + name + ".json"));
  }
  return all;
}

TEST(ConfigFuzz, NoMutationIsAcceptedWithAKeyThatIsIgnored) {
  const ConfigFuzz fuzz(examples());
  std::array<int, 4> outcomes{};
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const auto result = fuzz.run(seed);
    EXPECT_EQ(result.fault, "") << "seed " << seed << "\n" << result.text;
    ++outcomes[static_cast<std::size_t>(result.outcome)];
  }
  for (const int count : outcomes) EXPECT_GT(count, 3) << "each outcome is reached";
}

TEST(ConfigFuzz, TheSameSeedIsTheSameConfiguration) {
  const ConfigFuzz fuzz(examples());
  EXPECT_EQ(fuzz.run(5).text, fuzz.run(5).text);
  EXPECT_NE(fuzz.run(5).text, fuzz.run(6).text);
}

TEST(ConfigFuzz, JudgesWhatTheLoaderSays) {
  for (const std::string& text : examples())
    EXPECT_EQ(ConfigFuzz::judge(text).outcome, Outcome::kValid) << text;
  EXPECT_EQ(ConfigFuzz::judge(R"({"wall": {"rate": {"rate_hz": 900}}})").outcome,
            Outcome::kAdjusted);
  EXPECT_EQ(ConfigFuzz::judge(R"({"wall": {"rate": {"speed": 9}}})").outcome, Outcome::kInvalid);
  EXPECT_EQ(ConfigFuzz::judge(R"({"instance": "a", "instance": "b"})").outcome, Outcome::kNoJson);
  EXPECT_EQ(ConfigFuzz::judge("{").outcome, Outcome::kNoJson);
}

}  // namespace
}  // namespace merlin::bench
