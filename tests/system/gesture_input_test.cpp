// Gestures at a real merlind: a transcript of a Fastrak worn by a synthetic person is replayed as
// the tracker's line, beside an emulated glove.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/commands.h"
#include "daemon/status/client.h"
#include "drivers/fastrak/protocol.h"
#include "drivers/hand/movement_recording.h"
#include "drivers/io/transcript.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;

constexpr std::size_t kNextMode = actionIndex("next_mode"), kResetView = actionIndex("reset_view"),
                      kGrab = actionIndex("grab");
constexpr const char* kGesture = "circle_clockwise";
constexpr std::int64_t kSecond_ns = 1'000'000'000;

std::string recordOf(const TrackerSample& sample) {
  fastrak::Record record;
  for (std::size_t i = 0; i < 3; ++i) record.position[i] = 100 * sample.position_m[i];
  std::copy(std::begin(sample.orientation_wxyz), std::end(sample.orientation_wxyz),
            record.orientation_wxyz.begin());
  return encode(record, fastrak::kDriverList, {});
}

// Returns the transcript of a Fastrak that measured these samples. A minute of a hand at rest
// follows them, since a transcript that has ended is replayed from its beginning.
std::string transcriptOf(const std::vector<TrackerSample>& samples) {
  io::Transcript transcript =
      *io::readTranscript(kSource + "/tests/transcripts/fastrak/1-0-none.bytes");
  auto& chunks = transcript.chunks;
  while (!chunks.back().to_device) chunks.pop_back();  // removes everything after the dialogue
  const Duration from = chunks.back().at + std::chrono::milliseconds(10);
  const std::int64_t first_ns = samples.front().received_ns;
  for (const TrackerSample& sample : samples)
    chunks.push_back({from + Duration(sample.received_ns - first_ns), false, recordOf(sample)});
  for (int i = 0; i < 60 * 30; ++i)
    chunks.push_back(
        {chunks.back().at + std::chrono::milliseconds(33), false, chunks.back().bytes});
  return formatTranscript(transcript);
}

// Returns the tracker's samples from 1 s before the person's gesture to 0.5 s after it.
std::vector<TrackerSample> samplesOfAGesture() {
  const hand::Performance all = hand::makeGestures(hand::MovingPerson(7003), 1, 11);
  const auto made =
      std::ranges::find(all.made, std::string_view(kGesture), &hand::MadeGesture::name);
  std::vector<TrackerSample> samples;
  for (const TrackerSample& sample : all.samples) {
    if (sample.received_ns > made->began_ns - kSecond_ns &&
        sample.received_ns < made->ended_ns + kSecond_ns / 2)
      samples.push_back(sample);
  }
  return samples;
}

class GestureInput : public testing::Test {
 protected:
  // The tracker has no port until play() is called.
  GestureInput() {
    EXPECT_TRUE(glove_.saysEventually("cyberglove on")) << glove_.output();
    merlind_.emplace(dir_, "", "gestures",
                     MerlindOptions{.role = "devices", .emulate = false, .also = settings("")});
    EXPECT_TRUE(merlind_->ready()) << merlind_->process().output();
    EXPECT_TRUE(merlind_->healthIs("glove", HealthState::kOk));
    written_ = json::parse(readText(merlind_->config()));
  }
  json settings(const std::string& port) const {
    return {{"devices",
             {deviceEntry("glove", "cyberglove", "pty:" + dir_ / "glove"),
              deviceEntry("tracker", "fastrak", port)}},
            {"gestures", {{"file", kSource + "/config/gestures.json"}}},
            {"bindings",
             {{{"input", "posture.fist"}, {"action", "grab"}},
              {{"input", std::string("hand.gesture.") + kGesture}, {"action", "next_mode"}},
              {{"input", "gesture.push"}, {"action", "reset_view"}}}}};
  }
  // Replays a transcript of these samples as the tracker's line, from its beginning. `name`: the
  // transcript's file name.
  void play(const std::string& name, const std::vector<TrackerSample>& samples) {
    writeText(dir_ / name, transcriptOf(samples));
    written_.merge_patch(settings("replay:" + dir_ / name));
    writeText(merlind_->config(), written_.dump(2));
    const Outcome done = run({kMerlin, "reload", "--instance", merlind_->instance()});
    ASSERT_EQ(done.status, 0) << done.output;
  }
  // The emulated person makes a fist (`holds`) or opens it; returns once the action grab has begun
  // or ended.
  void grab(bool holds) {
    glove_.type("\n");
    ASSERT_TRUE(eventually([&] {
      const auto state = merlind_->actions("glove");
      return state && (state->held[kGrab] != 0) == holds;
    })) << glove_.output();
  }
  const shm::DeviceSlots::Hand& hand() { return *merlind_->devices()->hand("hand"); }
  GestureState state() { return hand().gesture->read().value_or(GestureState{}); }
  std::uint32_t begun(std::size_t action) {
    return merlind_->actions("hand").value_or(shm::ActionState{}).begun[action];
  }
  bool sends(std::uint64_t more) {
    const std::uint64_t to = hand().samples->count() + more;
    return eventually([&] { return hand().samples->count() >= to; });
  }

  TempDir dir_;
  Process glove_{{kMerlin, "emulate", "cyberglove", "--link", dir_ / "glove", "--script",
                  "grabbing", "--step", "--epoch-ns", "1"}};
  std::optional<Merlind> merlind_;
  json written_;
};

TEST_F(GestureInput, RunsItsCommandOnceAndNotWhileTheHandGrabs) {
  ASSERT_NO_FATAL_FAILURE(grab(true));
  ASSERT_NO_FATAL_FAILURE(play("held.bytes", samplesOfAGesture()));
  EXPECT_TRUE(eventually([&] { return state().passed_over == 1; }));
  EXPECT_EQ(state().counter, 0u) << state().name;
  EXPECT_EQ(begun(kNextMode), 0u);

  ASSERT_NO_FATAL_FAILURE(grab(false));
  ASSERT_NO_FATAL_FAILURE(play("free.bytes", samplesOfAGesture()));
  EXPECT_TRUE(eventually([&] { return begun(kNextMode) == 1; }));
  EXPECT_STREQ(state().name, kGesture);
  EXPECT_TRUE(sends(60)) << "two seconds of a hand at rest";
  EXPECT_EQ(state().counter, 1u);
  EXPECT_EQ(begun(kNextMode), 1u);
  EXPECT_EQ(begun(kResetView), 0u);

  json gesture;
  EXPECT_TRUE(eventually([&] {
    gesture = merlind_->status()["gestures"]["hand"];
    return gesture.is_object() && gesture["counter"] == 1;
  })) << gesture;
  EXPECT_EQ(gesture["name"], kGesture);
  EXPECT_EQ(gesture["passed_over"], 1);
  const Outcome shown = run({kMerlin, "status", "--instance", merlind_->instance()});
  EXPECT_NE(shown.output.find(fmt::format("gesture  hand: {}, ", kGesture)), std::string::npos)
      << shown.output;
  const auto events =
      status::ask(fmt::format("ipc://{}/{}-devices.command", dir_.path(), merlind_->instance()),
                  "events", std::chrono::seconds(10));
  ASSERT_TRUE(events) << events.error().what;
  EXPECT_NE(events->find(fmt::format("hand: gesture {}", kGesture)), std::string::npos) << *events;
}

TEST_F(GestureInput, OrdinaryMotionRunsNone) {
  using hand::Ordinary;
  std::vector<TrackerSample> samples;
  for (const Ordinary kind : {Ordinary::kPointing, Ordinary::kReaching}) {
    const auto some = hand::goAbout(hand::MovingPerson(7003), kind, 3, 5).samples;
    const std::int64_t later_ns =
        samples.empty() ? 0 : samples.back().received_ns + kSecond_ns - some.front().received_ns;
    for (TrackerSample sample : some) {
      sample.received_ns += later_ns;
      samples.push_back(sample);
    }
  }
  ASSERT_NO_FATAL_FAILURE(play("ordinary.bytes", samples));
  EXPECT_TRUE(sends(samples.size()));
  EXPECT_EQ(state().counter, 0u) << state().name;
  EXPECT_EQ(begun(kNextMode) + begun(kResetView), 0u);
}

}  // namespace
}  // namespace merlin::test
