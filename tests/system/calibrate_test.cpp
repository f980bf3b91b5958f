// merlin calibrate tracker and ball, the guided calibrations. A merlind reads an emulated device
// whose emulated person performs each step when the test says so.
#include <gtest/gtest.h>

#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;

// An emulated device, which goes to the next phase of its motion script when the test says so, and
// a merlind that reads the device.
class Bench {
 public:
  Bench(const char* device, const char* role, const char* script)
      : role_(role),
        driver_(device),
        device_({kMerlin, "emulate", device, "--link", dir_ / "line", "--script", script, "--step",
                 "--epoch-ns", "1"}) {
    EXPECT_TRUE(device_.saysEventually(std::string(device) + " on")) << device_.output();
  }

  // Starts a merlind that reads the device; `own`: the settings of the device's driver.
  Merlind& start(const json& own = json::object()) {
    merlind_.reset();
    merlind_ = std::make_unique<Merlind>(
        dir_, "", "calibrate" + std::to_string(++starts_),
        MerlindOptions{
            .role = "devices",
            .emulate = false,
            .also = onlyDevice(deviceEntry(role_, driver_, "pty:" + dir_ / "line", own))});
    EXPECT_TRUE(merlind_->ready()) << merlind_->process().output();
    EXPECT_TRUE(merlind_->healthIs(role_, HealthState::kOk)) << merlind_->process().output();
    return *merlind_;
  }
  Merlind& merlind() { return *merlind_; }

  void next() {
    const std::size_t said = device_.output().size();
    device_.type("\n");
    EXPECT_TRUE(eventually([&] { return device_.output().size() > said; })) << device_.output();
  }

  std::vector<std::string> calibrate(std::vector<std::string> also = {}) const {
    std::vector<std::string> words = {kMerlin, "calibrate",  role_,
                                      "-o",    file(),       "--hold",
                                      "0.4",   "--instance", merlind_->instance()};
    words.insert(words.end(), also.begin(), also.end());
    return words;
  }
  std::string file() const { return dir_ / "merlin.json"; }
  // Returns the settings of the device's driver from the configuration file.
  json saved() const {
    const json config = json::parse(readText(file()));
    for (const json& device : config["devices"]) {
      if (device["driver"] == driver_) return device.value(driver_, json::object());
    }
    return json::object();
  }

 private:
  TempDir dir_;
  std::string role_, driver_;
  Process device_;
  std::unique_ptr<Merlind> merlind_;
  int starts_ = 0;
};

// Waits until the station's samples are within 1 cm of `cm` on each axis.
void isAt(Merlind& merlind, const std::array<float, 3>& cm) {
  EXPECT_TRUE(eventually([&] {
    const auto sample = merlind.devices()->tracker()->stations[0]->newest();
    if (!sample) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      if (std::abs(100 * sample->position_m[i] - cm[i]) > 1) return false;
    }
    return true;
  })) << cm[0]
      << " " << cm[1] << " " << cm[2];
}

void expectNear(const json& list, const std::vector<double>& expected, double tolerance) {
  ASSERT_EQ(list.size(), expected.size()) << list;
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(list[i].get<double>(), expected[i], tolerance) << list;
}

constexpr std::size_t kSteps = 4;
using Places = std::array<std::array<float, 3>, kSteps>;  // [cm]

// Runs the calibration: waits for each step's prompt, moves the station there, and presses Enter.
void walkThrough(Bench& bench, const Places& places) {
  Process calibrate(bench.calibrate({"--station", "1"}));
  const char* const names[kSteps] = {
      "\norigin: ", "\nx axis: ", "\ny axis: ", "\nstraight ahead: "};
  for (std::size_t i = 0; i < kSteps; ++i) {
    ASSERT_TRUE(calibrate.saysEventually(names[i])) << calibrate.output();
    if (i > 0) bench.next();
    isAt(bench.merlind(), places[i]);
    calibrate.type("\n");
  }
  EXPECT_EQ(calibrate.wait(), 0) << calibrate.output();
  EXPECT_NE(calibrate.output().find("cm and"), std::string::npos)
      << "spread: " << calibrate.output();
}

const std::vector<double> kAlignment = {60, 5, -15, 60, 45, -15, 30, 10, -15};
const std::vector<double> kBoresight = {0.90631, 0, 0, -0.42262};

TEST(CalibrateTracker, GoesThroughPlacesAndAPose) {
  Bench bench("fastrak", "tracker", "alignment");
  bench.start();
  writeText(bench.file(), "{\"instance\": \"kept\"}");
  walkThrough(bench, {{{60, 5, -15}, {60, 45, -15}, {30, 10, -15}, {45, 20, -15}}});
  expectNear(bench.saved()["alignment1_cm"], kAlignment, 0.2);
  expectNear(bench.saved()["boresight1_wxyz"], kBoresight, 0.005);
  EXPECT_EQ(json::parse(readText(bench.file()))["instance"], "kept");
  EXPECT_EQ(run({kMerlind, "--check-config", bench.file(), "--role", "devices"}).status, 0);

  // With the saved calibration the pose is straight ahead, and a second calibration at the same
  // positions gives the same result.
  const auto& merlind = bench.start(bench.saved());
  isAt(bench.merlind(), {15, 15, 0});
  const auto ahead = bench.merlind().devices()->tracker()->stations[0]->newest();
  EXPECT_GT(std::abs(ahead->orientation_wxyz[0]), 0.999F);
  bench.next();  // back to the first position
  isAt(bench.merlind(), {0, 0, 0});
  writeText(bench.file(), readText(merlind.config()));
  walkThrough(bench, {{{0, 0, 0}, {40, 0, 0}, {5, 30, 0}, {15, 15, 0}}});
  expectNear(bench.saved()["alignment1_cm"], kAlignment, 0.3);
  expectNear(bench.saved()["boresight1_wxyz"], kBoresight, 0.01);
}

// The station does not move. Run without a terminal, the command must fail and leave the file
// unchanged.
TEST(CalibrateTracker, RefusesPlacesThatMakeNoFrameAndLeavesTheFile) {
  Bench bench("fastrak", "tracker", "alignment");
  bench.start();
  writeText(bench.file(), "{}");
  const Outcome done = run(bench.calibrate({"--pause", "0.1"}));
  EXPECT_EQ(done.status, 2) << done.output;
  EXPECT_NE(done.output.find("again: it is 0."), std::string::npos) << done.output;
  EXPECT_NE(done.output.find("x axis: refused 5 times"), std::string::npos) << done.output;
  EXPECT_EQ(readText(bench.file()), "{}");
  const Outcome absent = run(bench.calibrate({"--pause", "0.1", "--station", "3"}));
  EXPECT_EQ(absent.status, 1) << absent.output;
  EXPECT_NE(absent.output.find("0 samples came"), std::string::npos) << absent.output;
}

TEST(CalibrateTracker, KeepsWhatIsInForceOrSaysThatTheFileHasAnother) {
  Bench bench("fastrak", "tracker", "alignment");
  bench.start({{"alignment1_cm", {50, 0, 0, 50, 100, 0, -50, 0, 0}}});
  writeText(bench.file(), "{}");
  const Outcome other = run(bench.calibrate({"--pause", "0.1", "--steps", "boresight"}));
  EXPECT_EQ(other.status, 2) << other.output;
  EXPECT_NE(other.output.find(
                "/devices/1/fastrak/alignment1_cm differs from that of the running merlind"),
            std::string::npos)
      << other.output;
  EXPECT_EQ(readText(bench.file()), "{}");
  writeText(bench.file(), readText(bench.merlind().config()));
  const Outcome done = run(bench.calibrate({"--pause", "0.1", "--steps", "boresight"}));
  EXPECT_EQ(done.status, 0) << done.output;
  EXPECT_EQ(done.output.find("origin"), std::string::npos) << done.output;
  expectNear(bench.saved()["alignment1_cm"], {50, 0, 0, 50, 100, 0, -50, 0, 0}, 0.001);
  expectNear(bench.saved()["boresight1_wxyz"], {0.70711, 0, 0, -0.70711}, 0.005);
}

TEST(CalibrateTracker, EndsWithoutADaemonAndOnCtrlC) {
  Bench bench("fastrak", "tracker", "alignment");
  bench.start();
  writeText(bench.file(), "{}");
  Process calibrate(bench.calibrate());
  ASSERT_TRUE(calibrate.saysEventually("then press Enter")) << calibrate.output();
  EXPECT_EQ(calibrate.kill(SIGINT), 128 + SIGINT);
  Process orphan(bench.calibrate());
  ASSERT_TRUE(orphan.saysEventually("then press Enter")) << orphan.output();
  bench.merlind().process().kill(SIGTERM);
  EXPECT_EQ(orphan.wait(), 1) << orphan.output();
  EXPECT_NE(orphan.output().find("merlind has ended; nothing was changed"), std::string::npos)
      << orphan.output();
  const Outcome none = run(bench.calibrate());
  EXPECT_EQ(none.status, 2) << none.output;
  EXPECT_NE(none.output.find("no merlind with devices runs as"), std::string::npos) << none.output;
  EXPECT_EQ(readText(bench.file()), "{}");
}

// Runs the calibration: waits for each step's prompt, moves the ball, and presses Enter.
void moveThrough(Bench& bench) {
  Process calibrate(bench.calibrate());
  // For each step: the axis that is moved and its raw count.
  const std::pair<const char*, std::pair<int, int>> steps[] = {
      {"\nrest: ", {0, 12}},           {"\nright: ", {1, -6400}}, {"\nup: ", {0, 5600}},
      {"\ntowards you: ", {2, -7200}}, {"\ntilt: ", {4, -1280}},  {"\nturn: ", {3, 1200}},
      {"\nroll: ", {5, -1440}}};
  for (const auto& [name, counts] : steps) {
    ASSERT_TRUE(calibrate.saysEventually(name)) << calibrate.output();
    if (counts.second != 12) bench.next();
    ASSERT_TRUE(eventually([&, axis = counts.first, raw = counts.second] {
      const auto sample = bench.merlind().devices()->ball()->samples->newest();
      return sample && sample->raw[axis] == raw;
    })) << name;
    calibrate.type("\n");
  }
  EXPECT_EQ(calibrate.wait(), 0) << calibrate.output();
}

TEST(CalibrateBall, GoesThroughPushesAndTwists) {
  Bench bench("spaceball", "ball", "pushes");
  // The calibration uses raw counts, to which the configured axis map and dead zone do not apply.
  bench.start({{"axis_map", {3, 2, 1, 6, 5, 4}}, {"dead_zone", 99}});
  writeText(bench.file(),
            onlyDevice(deviceEntry("ball", "spaceball", "", {{"cubic", false}})).dump());
  moveThrough(bench);
  const json saved = bench.saved();
  EXPECT_EQ(saved["axis_map"], json({-2, 1, -3, -5, 4, -6}));
  EXPECT_EQ(saved["dead_zone"], 28);
  EXPECT_EQ(saved["full_scale_translation"], 5040);
  EXPECT_EQ(saved["full_scale_rotation"], 1080);
  EXPECT_EQ(saved["cubic"], false);
  EXPECT_EQ(run({kMerlind, "--check-config", bench.file(), "--role", "devices"}).status, 0);

  // With the saved calibration in force, the last twist is at full scale about the axis towards the
  // person.
  bench.start(saved);
  ASSERT_TRUE(eventually([&] {
    const auto sample = bench.merlind().devices()->ball()->samples->newest();
    return sample && sample->rotation[2] == 1;
  }));
  EXPECT_EQ(bench.merlind().devices()->ball()->samples->newest()->rotation[0], 0);
}

TEST(CalibrateBall, RefusesABallThatNobodyMoves) {
  Bench bench("spaceball", "ball", "pushes");
  bench.start();
  writeText(bench.file(), "{}");
  const Outcome done = run(bench.calibrate({"--pause", "0.1"}));
  EXPECT_EQ(done.status, 2) << done.output;
  EXPECT_NE(done.output.find("rest: "), std::string::npos) << done.output;
  EXPECT_NE(done.output.find("right: refused 5 times"), std::string::npos) << done.output;
  EXPECT_NE(done.output.find("8 counts (80 are needed): push it harder"), std::string::npos)
      << done.output;
  EXPECT_EQ(readText(bench.file()), "{}");
}

}  // namespace
}  // namespace merlin::test
