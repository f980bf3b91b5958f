// The wall survives damaged input: a model file that is overwritten while it is shown, and a model
// that a wrong tracker record moves out of sight.
#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "drivers/emulate/emulator.h"
#include "drivers/io/pty_master.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

// An emulated device on a pseudo-terminal, without a thread: a test that waits for a condition
// calls pump().
class Line {
 public:
  Line(const char* device, int baud, const emulate::MotionScript& script, const std::string& link)
      : pty_(*io::PtyMaster::open(link)),
        emulator_(emulate::findEmulator(device)->make({.baud = baud}, script, clock_.now())) {}

  void pump() {
    std::byte in[512];
    for (ssize_t n; (n = ::read(pty_.fd(), in, sizeof in)) > 0;)
      emulator_->receive(std::span(in, static_cast<std::size_t>(n)), clock_.now());
    emulator_->advance(clock_.now(), out_);
    const ssize_t n = out_.empty() ? 0 : ::write(pty_.fd(), out_.data(), out_.size());
    if (n > 0) out_.erase(0, static_cast<std::size_t>(n));
  }

 private:
  SystemClock clock_;
  io::PtyMaster pty_;
  std::unique_ptr<emulate::Emulator> emulator_;
  std::string out_;
};

enum Step : std::size_t { kRest, kGrab, kDamage, kLetGo };

constexpr emulate::HandPlace kNear = {{0.6F, 0, 0}}, kFar = {{4.9F, 0, 0}};
constexpr emulate::Phase kPhases[] = {
    {1, "flat", {}, 0, false, kNear},  // kRest
    {1, "flat", {}, 1, false, kNear},  // kGrab
    {1, "flat", {}, 1, false, kFar},   // kDamage
    {1, "flat", {}, 0, false, kFar},   // kLetGo
};

// The wall shows its own copy of the model, so it keeps drawing whatever happens to the file.
TEST(Survival, AModelThatIsOverwrittenWhileItIsShown) {
  const TempDir dir;
  const std::string model = makeModel(dir);
  Merlind merlind(dir, model, "overwritten", {.script = "turning"});
  ASSERT_TRUE(merlind.ready()) << merlind.process().output();
  const auto drawsOn = [&](const char* after) {
    const std::uint64_t before = merlind.wall().frames;
    EXPECT_TRUE(eventually([&] { return merlind.wall().frames > before + 5; })) << after;
  };
  const std::string whole = readText(model);
  const auto overwrite = [&](const std::string& bytes) {
    std::ofstream(model, std::ios::binary | std::ios::trunc) << bytes;
  };
  overwrite(whole.substr(0, whole.size() / 2));
  drawsOn("a smaller one");
  overwrite(std::string(whole.size(), '\xff'));
  drawsOn("other bytes");
  overwrite("");
  drawsOn("nothing");
  std::filesystem::remove(model);
  drawsOn("no file");
  EXPECT_EQ(merlind.process().kill(SIGTERM), 0);
}

TEST(Survival, AContentThatOneRecordFlungOutOfSightReturns) {
  const TempDir dir;
  std::size_t step = kRest;
  const emulate::MotionScript script{"damage", "", kPhases, &step};
  Line tracker("fastrak", 38400, script, dir / "tracker");
  Line ball("spaceball", 9600, script, dir / "ball");
  const nlohmann::json bindings = {{{"input", "ball.button.1"}, {"action", "grab"}}};
  Merlind m(dir, makeModel(dir, 5), "survival",
            {.emulate = false,
             .also = {{"devices",
                       {deviceEntry("tracker", "fastrak", "pty:" + dir / "tracker"),
                        deviceEntry("ball", "spaceball", "pty:" + dir / "ball")}},
                      {"bindings", bindings},
                      {"wall", {{"scene", {{"return_after_s", 0.5}}}}}}});
  const auto served = [&](auto condition) {
    return eventually([&] {
      tracker.pump();
      ball.pump();
      return condition();
    });
  };
  const auto hand_m = [&] {
    const auto sample = m.devices() ? m.devices()->tracker()->stations[0]->newest() : std::nullopt;
    return sample ? sample->position_m[0] : 0;
  };
  ASSERT_TRUE(served([&] { return hand_m() > 0.5F && m.wall().frames > 0; }))
      << m.process().output();
  step = kGrab;
  ASSERT_TRUE(served([&] { return m.wall().grabbed == 1; })) << m.process().output();
  step = kDamage;
  ASSERT_TRUE(served([&] { return hand_m() > 4.8F; }));
  const std::uint64_t frames = m.wall().frames;
  ASSERT_TRUE(served([&] { return m.wall().frames > frames + 1; }));
  step = kLetGo;
  ASSERT_TRUE(served([&] { return m.wall().grabbed == 0; }));
  EXPECT_TRUE(served([&] { return m.wall().returned == 1; })) << m.process().output();
  EXPECT_TRUE(served([&] {
    return m.process().output().find("the start view has returned") != std::string::npos;
  })) << m.process().output();
}

}  // namespace
}  // namespace merlin::test
