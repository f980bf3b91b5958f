// What a merlind that was killed leaves for whoever looks for the fault.
#include <filesystem>

#include <gtest/gtest.h>

#include "drivers/io/transcript.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

// The name behind these words in a program's output.
std::string fileAfter(const Process& process, const std::string& words) {
  const std::string said = process.output();
  const std::size_t at = said.find(words);
  if (at == std::string::npos) return {};
  const std::size_t begin = at + words.size();
  return said.substr(begin, said.find('\n', begin) - begin);
}

TEST(Crash, LeavesTheLastBytesOfEachDeviceAndTheLastFrame) {
  const TempDir dir;
  Merlind merlind(dir, makeModel(dir, 2), "killed");
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  ASSERT_TRUE(merlind.healthIs("ball", HealthState::kOk));
  EXPECT_TRUE(eventually([&] { return merlind.wall().frames > 2; }));
  merlind.process().kill(SIGKILL);

  Process again({kMerlind, "--config", merlind.config(), "--emulate"});
  ASSERT_TRUE(again.saysEventually("ready")) << again.output();
  for (const char* device : {"ball", "glove", "tracker"}) {
    const std::string words = std::string("the last bytes of ") + device + " before that are in ";
    ASSERT_TRUE(again.saysEventually(words)) << again.output();
    const std::string file = fileAfter(again, words);
    const auto transcript = io::readTranscript(file);
    ASSERT_TRUE(transcript) << transcript.error().what;
    EXPECT_GT(transcript->chunks.size(), 3U) << file;
  }
  ASSERT_TRUE(again.saysEventually("the last frame before that is in ")) << again.output();
  const std::string frame = fileAfter(again, "the last frame before that is in ");
  EXPECT_EQ(readText(frame).substr(1, 3), "PNG") << frame;
  EXPECT_EQ(again.kill(SIGTERM), 0);

  Process third({kMerlind, "--config", merlind.config(), "--emulate"});
  ASSERT_TRUE(third.saysEventually("ready")) << third.output();
  EXPECT_EQ(third.kill(SIGTERM), 0);
  EXPECT_EQ(third.output().find("killed or crashed"), std::string::npos)
      << "the one before ended in order: " << third.output();
}

}  // namespace
}  // namespace merlin::test
