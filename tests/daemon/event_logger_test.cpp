// Which events are logged, and in which words.
#include "daemon/base/event_logger.h"

#include <gtest/gtest.h>

namespace merlin {
namespace {

using std::chrono::seconds;
using Lines = std::vector<std::string>;

class EventLoggerTest : public testing::Test {
 protected:
  void log(const std::string& what, bool is_fault = true, const EventKind& kind = kDeviceEvent) {
    logger_.log(kind, is_fault ? faultEvent(what) : newsEvent(what), now_);
  }
  // Lets `for_s` seconds pass; calls the logger ten times a second, as merlind does.
  void wait(int for_s) {
    for (int i = 0; i < 10 * for_s; ++i) {
      now_ += std::chrono::milliseconds(100);
      logger_.tellLeftOut(now_);
    }
  }
  Lines lines() { return std::exchange(lines_, {}); }

  Timestamp now_{seconds(1000)};
  Lines lines_;
  EventLogger logger_{"wall", [this](LogLevel level, std::string_view text, const LogFields& f) {
                        lines_.push_back(fmt::format(
                            "{} {} {}: {}", level == LogLevel::kWarning ? "warning" : "info",
                            f.role, f.kind, text));
                      }};
};

TEST_F(EventLoggerTest, AFaultIsAWarningAndARecoveryIsNone) {
  log("output png failed: no space left", true, kWallEvent);
  log("output png works again", false, kWallEvent);
  EXPECT_EQ(lines(), (Lines{"warning wall wall: output png failed: no space left",
                            "info wall wall: output png works again"}));
}

TEST_F(EventLoggerTest, OfAFlappingDeviceThirtyLinesAreWrittenAndThenOneAMinuteWithTheirNumber) {
  for (int i = 0; i < 1000; ++i) log("glove: absent (no record for 0." + std::to_string(i) + " s)");
  EXPECT_EQ(lines().size(), 30U);
  wait(59);
  EXPECT_EQ(lines(), Lines{});
  wait(2);
  EXPECT_EQ(lines(),
            Lines{"warning wall device: 970 more of these events were left out of the log, "
                  "the last: glove: absent (no record for 0.999 s)"});
  wait(600);
  EXPECT_EQ(lines(), Lines{}) << "nothing more was left out";
  log("glove: absent (no record for 1 s)");
  EXPECT_EQ(lines().size(), 1U);
}

TEST_F(EventLoggerTest, AnotherDevicesFaultIsStillWritten) {
  for (int i = 0; i < 60; ++i) log("glove: absent (unplugged)");
  lines();
  log("tracker: absent (unplugged)");
  EXPECT_EQ(lines(), Lines{"warning wall device: tracker: absent (unplugged)"});
}

TEST_F(EventLoggerTest, SentencesThatAlwaysDifferAreLimitedByTheirKind) {
  const auto differing = [](int i) {
    std::string text = "refused: ";
    for (; i > 0; i /= 26) text += static_cast<char>('a' + i % 26);
    return text;
  };
  constexpr int kCalls = 2000;  // more than there are subjects
  for (int i = 1; i <= kCalls; ++i) log(differing(i), true, kServerEvent);
  EXPECT_EQ(lines().size(), 240U);
  wait(11);
  EXPECT_EQ(lines(),
            Lines{"warning wall server: 1760 more events of the kind server were left out of the "
                  "log"});
  log("glove: absent (unplugged)");
  EXPECT_EQ(lines().size(), 1U) << "another kind has its own";
}

}  // namespace
}  // namespace merlin
