// Bindings and projectors of a configuration: the loader refuses those that could have no effect.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "config/loader.h"
#include "tests/support/findings.h"

namespace merlin {
namespace {

using test::findingsOf;
using Verdict = LoadedSettings::Verdict;

std::string bindingsAre(const std::string& list) {
  return findingsOf(loadSettings("{\"bindings\": [" + list + "]}", ""));
}

TEST(BindingsConfig, BindingsThatConflictAreNamedBoth) {
  const std::string fist = R"({"input": "posture.fist", "action": "grab"})";
  EXPECT_EQ(bindingsAre(fist), "");
  EXPECT_EQ(bindingsAre(fist + "," + fist),
            "f.json:1: /bindings/1 conflicts with /bindings/0 (line 1): "
            "\"posture.fist\" would grab twice when held\n");
  EXPECT_EQ(bindingsAre(fist + ",\n" + R"({"input": "posture.fist", "action": "fly"})"),
            "f.json:2: /bindings/1 conflicts with /bindings/0 (line 1): "
            "\"posture.fist\" would both grab and fly when held, which exclude each other\n");
  EXPECT_EQ(
      bindingsAre(R"({"input": "axis.x+", "action": "previous_content"},)"
                  R"({"input": "ball.axis.x+", "action": "next_content"})"),
      "f.json:1: /bindings/1 conflicts with /bindings/0 (line 1): \"ball.axis.x+\" would both "
      "previous_content and next_content when entered, which exclude each other\n");
  const std::string fist_left =
      R"({"input": "posture.fist", "action": "reset_view", "on": "leave"})";
  EXPECT_EQ(bindingsAre(fist + "," + fist_left), "");
  EXPECT_EQ(bindingsAre(fist_left + "," + fist_left),
            "f.json:1: /bindings/1 conflicts with /bindings/0 (line 1): "
            "\"posture.fist\" would reset_view twice when left\n");
}

TEST(BindingsConfig, ChordsThatConflictAreFoundInEitherOrder) {
  const auto chord = [](const char* input, const char* with, const char* action) {
    return fmt::format(R"({{"input": "button.{}", "with": "button.{}", "action": "{}"}})", input,
                       with, action);
  };
  const auto alone = [](const char* input, const char* action) {
    return fmt::format(R"({{"input": "button.{}", "action": "{}"}})", input, action);
  };
  const std::string both = "would both grab and fly when held, which exclude each other";
  EXPECT_NE(bindingsAre(chord("1", "2", "grab") + "," + chord("2", "1", "fly")).find(both),
            std::string::npos)
      << "the same chord";
  EXPECT_NE(bindingsAre(chord("1", "2", "next_mode") + "," + chord("2", "1", "next_mode"))
                .find("would next_mode twice"),
            std::string::npos);
  EXPECT_NE(bindingsAre(alone("1", "grab") + "," + chord("2", "1", "fly")).find(both),
            std::string::npos)
      << "both are held";
  EXPECT_NE(bindingsAre(chord("2", "1", "grab") + "," + alone("1", "fly")).find(both),
            std::string::npos);
  EXPECT_EQ(bindingsAre(chord("1", "2", "align_undo") + ",\n" + chord("2", "1", "reset_view")),
            "f.json:2: /bindings/1 conflicts with /bindings/0 (line 1): \"button.2\" with "
            "\"button.1\" and the same two inputs in the other order are one chord, which would "
            "both align_undo and reset_view\n");
  EXPECT_NE(bindingsAre(chord("1", "2", "grab") + "," + chord("2", "1", "reset_view"))
                .find("in the other order are one chord"),
            std::string::npos)
      << "one lasts, the other happens once";
  EXPECT_EQ(bindingsAre(alone("1", "next_mode") + "," + chord("2", "1", "fly")), "");
  EXPECT_EQ(bindingsAre(chord("2", "1", "move_left") + "," + chord("3", "1", "move_right")), "")
      << "button 1 is held like a shift key";
}

TEST(BindingsConfig, OneMomentChangesWhatIsShownInOneWay) {
  const auto bound = [](const char* action, const char* also) {
    return fmt::format(R"({{"input": "button.1", "action": "{}"{}}})", action, also);
  };
  const char *const held = R"(, "after_s": 1)", *const longer = R"(, "after_s": 2)";
  const char* const chord = R"(, "with": "button.2")";
  const char* const left = R"(, "on": "leave")";
  for (const char* const also : {"", held, chord, left}) {
    EXPECT_NE(bindingsAre(bound("reset_view", also) + ",\n" + bound("blank", also))
                  .find("f.json:2: /bindings/1 conflicts with /bindings/0 (line 1): \"button.1\" "
                        "would both reset_view and blank when "),
              std::string::npos)
        << also;
  }
  EXPECT_NE(bindingsAre(bound("next_mode", held) + "," + bound("freeze", held))
                .find("; of the actions that change what is shown or what the ball moves, an input "
                      "triggers only one at a time\n"),
            std::string::npos);
  const char* const moments[] = {"", held, longer, chord, left};
  for (const char* const one : moments) {
    for (const char* const other : moments) {
      if (one == other) continue;
      EXPECT_EQ(bindingsAre(bound("reset_view", one) + "," + bound("blank", other)), "")
          << one << other;
    }
  }
  EXPECT_EQ(bindingsAre(bound("grab", "") + "," + bound("reset_view", "")), "")
      << "one lasts, the other happens once";
  EXPECT_EQ(bindingsAre(bound("align_left", "") + "," + bound("align_up", "")), "");
  EXPECT_EQ(findingsOf(loadSettings(R"({"wall": {"snapshots": "taken"}, "bindings": [)" +
                                        bound("snapshot", "") + "," + bound("blank", "") + "]}",
                                    "")),
            "")
      << "they act on different things";
}

TEST(BindingsConfig, AChordThatCannotHappenIsFound) {
  const auto chord = [](const char* input, const char* with) {
    return bindingsAre(
        fmt::format(R"({{"input": "{}", "with": "{}", "action": "reset_view"}})", input, with));
  };
  EXPECT_EQ(chord("axis.x+", "axis.x-"),
            "f.json:1: /bindings/0/with is \"axis.x-\", which is never held together with "
            "\"axis.x+\", so the chord would never happen\n");
  const char* const never[][2] = {{"axis.rz-", "axis.rz+"},        {"posture.fist", "posture.open"},
                                  {"touch.pinch", "touch.spread"}, {"button.1", "posture.fist"},
                                  {"button.1", "pinch"},           {"switch", "key.space"}};
  for (const auto& [input, with] : never)
    EXPECT_NE(chord(input, with).find("is never held together"), std::string::npos) << input;
  const char* const possible[][2] = {{"axis.x+", "axis.y-"},     {"axis.x+", "axis.rx-"},
                                     {"axis.x+", "button.12"},   {"button.1", "button.12"},
                                     {"switch", "posture.fist"}, {"key.space", "button.1"},
                                     {"pinch", "button.right"}};
  for (const auto& [input, with] : possible) EXPECT_EQ(chord(input, with), "") << input;
}

TEST(BindingsConfig, AChordIsTheSameWithAndWithoutItsDevice) {
  const auto chords = [](const char* input, const char* with, const char* action) {
    return bindingsAre(fmt::format(
        R"({{"input": "button.6", "with": "button.7", "action": "next_mode"}},
           {{"input": "{}", "with": "{}", "action": "{}"}})",
        input, with, action));
  };
  const std::string twice = "would next_mode twice when entered";
  EXPECT_NE(chords("ball.button.6", "ball.button.7", "next_mode").find(twice), std::string::npos);
  EXPECT_NE(chords("ball.button.7", "ball.button.6", "next_mode").find(twice), std::string::npos);
  EXPECT_EQ(chords("ball.button.6", "ball.button.8", "next_mode"), "");
}

TEST(BindingsConfig, ActionsThatNothingCouldDoAreFound) {
  const std::string bindings =
      R"("bindings": [{"input": "posture.a", "action": "snapshot"},
                      {"input": "posture.b", "action": "lamp_slow"},
                      {"input": "posture.c", "action": "next_content"}])";
  EXPECT_EQ(findingsOf(loadSettings("{" + bindings + "}", "")),
            "f.json:1: /bindings/0/action is snapshot, which needs a folder: "
            "/wall/snapshots names none\n"
            "f.json:2: /bindings/1/action is lamp_slow, which needs a lamp: "
            "/gpio has no chip with a lamp_line\n")
      << "the next content may be a slide of a folder that somebody shows";
  EXPECT_EQ(findingsOf(loadSettings(R"({"wall": {"snapshots": "taken"},
                                "gpio": {"chip": "gpiochip0", "lamp_line": 5}, )" +
                                        bindings + "}",
                                    "")),
            "");
  EXPECT_NE(bindingsAre(R"({"input": "posture.a", "action": "lamp_on"},
                          {"input": "posture.a", "action": "lamp_off"})")
                .find("\"posture.a\" would both lamp_on and lamp_off when entered"),
            std::string::npos);
}

TEST(BindingsConfig, ProjectorsAndTheirScheduleAreChecked) {
  const auto loaded = loadSettings(R"({
      "projectors": [{"name": "left", "address": "10.0.0.7", "password_file": "p", "warm_up_s": 60}],
      "projector_schedule": [{"days": ["mon", "sun"], "on": "09:00", "off": "17:30"}]})",
                                   "/etc/merlin");
  ASSERT_EQ(loaded.verdict(), Verdict::kValid) << findingsOf(loaded);
  EXPECT_EQ(loaded.settings.devices.projectors[0].password_file, "/etc/merlin/p");
  EXPECT_EQ(loaded.settings.devices.projector_schedule[0].days,
            (std::vector<std::string>{"mon", "sun"}));
  EXPECT_EQ(findingsOf(loadSettings(R"({
      "projector_schedule": [{"days": ["monday"], "on": "09:00", "off": "17:30"}]})",
                                    "")),
            "f.json:2: /projector_schedule/0/days/0 is \"monday\"; allowed are mon, tue, "
            "wed, thu, fri, sat, sun\n"
            "f.json:2: /projector_schedule needs projectors: /projectors is empty, "
            "and /gpio has no chip with a projector_line\n");
  EXPECT_EQ(bindingsAre(R"({"input": "posture.a", "action": "projector_on"})"),
            "f.json:1: /bindings/0/action is projector_on, which needs projectors: "
            "/projectors is empty, and /gpio has no chip with a projector_line\n");
}

TEST(BindingsConfig, BindingsThatNameNothingAreFound) {
  EXPECT_NE(bindingsAre(R"({"input": "ball.button.13", "action": "grab"})")
                .find("allowed are DEVICE.button.1 to DEVICE.button.12"),
            std::string::npos);
  EXPECT_NE(bindingsAre(R"({"input": "posture.a", "action": "grab", "on": "leave"})")
                .find("/bindings/0/on is leave, but grab lasts as long as its input is "
                      "held: set hold"),
            std::string::npos);
  EXPECT_NE(bindingsAre(R"({"input": "posture.a", "action": "dance"})").find("fly"),
            std::string::npos)
      << "the list of what exists";
}

TEST(BindingsConfig, ABindingWithoutAnActionIsFoundAndGrabsNothing) {
  const auto loaded = loadSettings(R"({"bindings": [{"input": "posture.fist"},
      {"input": "posture.fist", "on": "leave"}, {"input": "posture.fist", "action": "grab"}]})",
                                   "");
  ASSERT_EQ(loaded.verdict(), Verdict::kInvalid);
  const std::string what = "has no action: name one in \"action\", one of reset_view, next_mode, ";
  const std::string findings = findingsOf(loaded);
  EXPECT_NE(findings.find("f.json:1: /bindings/0 " + what), std::string::npos) << findings;
  EXPECT_NE(findings.find("f.json:2: /bindings/1 " + what), std::string::npos) << findings;
  EXPECT_EQ(std::count(findings.begin(), findings.end(), '\n'), 2) << findings;
  EXPECT_EQ(loaded.settings.devices.bindings[0].action, "");
}

TEST(BindingsConfig, AnActionThatIsNoneIsFoundOnce) {
  const std::string findings = bindingsAre(R"({"input": "posture.a", "action": "dance"})");
  EXPECT_TRUE(findings.starts_with("f.json:1: /bindings/0/action is the string \"dance\"; "))
      << findings;
  EXPECT_EQ(std::count(findings.begin(), findings.end(), '\n'), 1) << findings;
}

}  // namespace
}  // namespace merlin
