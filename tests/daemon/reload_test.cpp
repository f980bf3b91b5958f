// Which settings a running merlind takes over: the table of settings, a plan, and the effect of a
// plan.
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "config/effective.h"
#include "config/visitor.h"
#include "daemon/reload/answer.h"
#include "daemon/reload/plan.h"

namespace merlin::reload {
namespace {

// Changes the value of the setting at one JSON pointer.
class Changer final : public SettingsVisitor {
 public:
  explicit Changer(std::string pointer) : pointer_(std::move(pointer)) {}
  void number(const char* key, double& value, Range range, const char*) override {
    if (is(key)) value = value == range.low ? range.high : range.low;
  }
  void integer(const char* key, int& value, Range range, const char*) override {
    const int low = static_cast<int>(range.low);
    if (is(key)) value = value == low ? low + 1 : low;
  }
  void flag(const char* key, bool& value, const char*) override {
    if (is(key)) value = !value;
  }
  void text(const char* key, std::string& value, const char*) override {
    if (is(key)) value += "x";
  }
  void texts(const char* key, std::vector<std::string>& values, const char*) override {
    if (is(key)) values.emplace_back("x");
  }
  void path(const char* key, std::string& value, const char*) override {
    if (is(key)) value += "x";
  }
  void choice(const char* key, int& value, std::span<const char* const> names,
              const char*) override {
    if (is(key)) value = (value + 1) % static_cast<int>(names.size());
  }
  void numbers(const char* key, std::span<double> values, Range range, const char*) override {
    if (is(key)) values[0] = values[0] == range.low ? range.high : range.low;
  }
  void group(const char* key, const char*, const std::function<void()>& members) override {
    within(key, members);
  }
  void list(const char* key, std::size_t count, const char*,
            const std::function<void(std::size_t)>& resize,
            const std::function<void(std::size_t)>& member) override {
    if (is(key)) return resize(count + 1);
    for (std::size_t i = 0; i < count; ++i)
      within(std::string(key) + "/" + std::to_string(i), [&] { member(i); });
  }
  void excluded(const char*, const char*) override {}

 private:
  bool is(const char* key) const { return at_ + "/" + key == pointer_; }
  void within(const std::string& key, const std::function<void()>& members) {
    const std::string outer = at_;
    at_ += "/" + key;
    members();
    at_ = outer;
  }
  std::string pointer_, at_;
};

Settings changed(const std::string& pointer, Settings settings = {}) {
  Changer changer(pointer);
  describe(settings, changer);
  return settings;
}

Plan planOf(const std::vector<std::string>& pointers, Readers process) {
  Settings fresh;
  for (const std::string& pointer : pointers) fresh = changed(pointer, fresh);
  return planFor(changesBetween({}, fresh), process);
}

std::vector<std::string> pointersOf(const std::vector<SettingChange>& changes) {
  std::vector<std::string> pointers;
  for (const SettingChange& change : changes) pointers.push_back(change.pointer);
  return pointers;
}

TEST(ReloadTable, HasARowForEverySetting) {
  for (const SettingValue& setting : valuesOf({}))
    EXPECT_FALSE(takerOf(setting.pointer).pointer.empty()) << setting.pointer;
}

TEST(ReloadTable, NamesOnlySettingsThatThereAre) {
  const auto all = valuesOf({});
  std::set<std::string_view> rows;
  for (const Taker& row : takers()) {
    EXPECT_TRUE(rows.insert(row.pointer).second) << row.pointer << " is there twice";
    EXPECT_NE(row.readers, 0u) << row.pointer;
    std::string pointer(row.pointer);
    if (const auto any = pointer.find('*'); any != std::string::npos) pointer[any] = '0';
    const std::string group = pointer + "/";
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const SettingValue& setting) {
      return setting.pointer == pointer || setting.pointer.starts_with(group);
    })) << row.pointer;
  }
}

TEST(ReloadTable, ASettingThatItDoesNotKnowNeedsARestart) {
  EXPECT_EQ(takerOf("/new").part, Part::kRestart);
  EXPECT_EQ(takerOf("/new").readers, kAll);
  EXPECT_EQ(takerOf("/wall/new/thing").part, Part::kRestart);
  EXPECT_EQ(takerOf("/wall/scene/new").part, Part::kRestart);
  EXPECT_EQ(takerOf("/bindings_too").part, Part::kRestart) << "another word";
  EXPECT_EQ(takerOf("/bindings/7/new").part, Part::kBindings);
  EXPECT_EQ(takerOf("").part, Part::kRestart);
}

// Changes one setting at a time. After the plan was carried out, exactly what it swaps must be in
// effect.
TEST(ReloadPlan, WhatIsSwappedIsTaken) {
  int swapped = 0;
  for (const SettingValue& setting : valuesOf({})) {
    const Settings fresh = changed(setting.pointer);
    const auto changes = changesBetween({}, fresh);
    if (setting.pointer.ends_with("/driver")) continue;  // another driver has other settings
    const Plan plan = planFor(changes, kDevices | kWall);
    Settings running;
    adopt(plan, fresh, false, running);
    if (plan.restart.empty() && plan.elsewhere.empty()) {
      ++swapped;
      EXPECT_TRUE(changesBetween(running, fresh).empty()) << setting.pointer;
    } else {
      EXPECT_TRUE(plan.swapped.empty()) << setting.pointer;
      EXPECT_TRUE(changesBetween({}, running).empty()) << setting.pointer;
    }
  }
  EXPECT_GT(swapped, 80);
}

TEST(ReloadPlan, AnEmulatorsPortStays) {
  Settings running;
  running.devices.list[2].line.port = "pty:/run/ball";
  Settings fresh;
  fresh.devices.list[2].line.port = "serial:/dev/ttyS0";
  fresh.devices.list[2].line.baud = 4800;
  const Plan plan = planFor(changesBetween({}, fresh), kDevices);
  adopt(plan, fresh, true, running);
  EXPECT_EQ(running.devices.list[2].line.port, "pty:/run/ball");
  EXPECT_EQ(running.devices.list[2].line.baud, 4800);
  adopt(plan, fresh, false, running);
  EXPECT_EQ(running.devices.list[2].line.port, "serial:/dev/ttyS0");
}

TEST(ReloadPlan, EachProcessTakesItsPart) {
  const std::vector<std::string> mixed = {"/devices/0/cyberglove/filter", "/wall/rate/rate_hz",
                                          "/hands/0/station", "/page/port"};
  const Plan devices = planOf(mixed, kDevices), wall = planOf(mixed, kWall);
  EXPECT_TRUE(devices.restart.empty());
  EXPECT_EQ(pointersOf(devices.swapped),
            (std::vector<std::string>{"/devices/0/cyberglove/filter", "/hands/0/station"}));
  EXPECT_TRUE(devices.has(Part::kLine) && devices.has(Part::kHand));
  EXPECT_EQ(devices.lines, std::vector<bool>{true}) << "the first device's";
  EXPECT_FALSE(devices.has(Part::kRate));
  EXPECT_EQ(pointersOf(wall.swapped),
            (std::vector<std::string>{"/hands/0/station", "/wall/rate/rate_hz"}))
      << "the wall reads the hand";
  EXPECT_EQ(pointersOf(wall.elsewhere),
            (std::vector<std::string>{"/devices/0/cyberglove/filter", "/page/port"}));
  EXPECT_EQ(pointersOf(planOf({"/serve/vrpn_port"}, kWall).elsewhere).size(), 1u);
  EXPECT_EQ(pointersOf(planOf({"/serve/vrpn_port"}, kWall | kMirror).restart).size(), 1u);
  EXPECT_EQ(pointersOf(planOf({"/serve/wall_endpoint"}, kWall).restart).size(), 1u);
  EXPECT_EQ(pointersOf(planOf({"/serve/wall_endpoint"}, kDevices).elsewhere).size(), 1u);
  EXPECT_EQ(pointersOf(planOf({"/serve/commands_clients"}, kDevices).restart).size(), 1u);
  EXPECT_EQ(pointersOf(planOf({"/instance"}, kWall).restart).size(), 1u);
}

TEST(ReloadPlan, ABindingMoreOrLessIsAChange) {
  Settings fewer;
  fewer.devices.bindings.pop_back();
  EXPECT_TRUE(planFor(changesBetween({}, fewer), kDevices).has(Part::kBindings));
  Settings more;
  more.devices.bindings.push_back({"ball.button.5", "freeze"});
  EXPECT_TRUE(planFor(changesBetween({}, more), kDevices).has(Part::kBindings));
  EXPECT_TRUE(planFor(changesBetween(more, more), kDevices).swapped.empty());
}

TEST(ReloadAnswer, SaysWhatAndWhyNot) {
  Answer answer;
  answer.file = "/etc/m.json";
  answer.plan = planOf({"/wall/rate/rate_hz"}, kWall);
  auto json = nlohmann::json::parse(answerText(answer));
  EXPECT_EQ(json["outcome"], "done");
  EXPECT_EQ(json["swapped"][0]["setting"], "/wall/rate/rate_hz");
  EXPECT_EQ(json["swapped"][0]["from"], "30");
  EXPECT_EQ(json["swapped"][0]["to"], "1");
  EXPECT_EQ(refusal(answer), "");
  answer.outcome = Outcome::kRestarts;
  answer.plan = planOf({"/wall/render/gpu", "/wall/input/keys"}, kWall);
  json = nlohmann::json::parse(answerText(answer));
  EXPECT_EQ(json["outcome"], "restarts");
  EXPECT_EQ(json["restart"], (nlohmann::json{"/wall/input/keys", "/wall/render/gpu"}));
  EXPECT_EQ(restartReason(answer.plan), "/wall/input/keys (and 1 more)");
  EXPECT_EQ(refusal(answer), "");
  answer.outcome = Outcome::kInvalid;
  answer.findings = {"/etc/m.json:3: /wal is not a known setting"};
  EXPECT_EQ(refusal(answer),
            "/etc/m.json:3: /wal is not a known setting; the previous settings stay in effect");
  answer.outcome = Outcome::kFailed;
  answer.failure = "std::bad_alloc";
  EXPECT_EQ(refusal(answer), "/etc/m.json: std::bad_alloc; the previous settings stay in effect");
}

TEST(ReloadAnswer, NamesTheAlignmentsThatAreSetAsideAndThoseThatComeBack) {
  Answer answer;
  answer.set_aside = {{"left", "it was made for 640 x 480 pixels"}};
  answer.brought_back = {"right"};
  const auto json = nlohmann::json::parse(answerText(answer));
  EXPECT_EQ(
      json["set_aside"],
      (nlohmann::json::array({{{"output", "left"}, {"why", "it was made for 640 x 480 pixels"}}})));
  EXPECT_EQ(json["brought_back"], nlohmann::json::array({"right"}));
}

TEST(ReloadAnswer, CutsALongValueBetweenCharacters) {
  Answer answer;
  answer.plan.swapped = {{"/x", "", "\"" + std::string(198, 'a') + "\xC3\xA4\xC3\xA4\""}};
  const auto json = nlohmann::json::parse(answerText(answer));
  EXPECT_EQ(json["swapped"][0]["to"], "\"" + std::string(198, 'a') + " ...");
}

}  // namespace
}  // namespace merlin::reload
