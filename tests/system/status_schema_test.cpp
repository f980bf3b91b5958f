// What merlind publishes and answers conforms to daemon/status/status.schema.json. The schema may
// only grow, since programs of other people rely on it.
#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "daemon/status/client.h"
#include "tests/support/json_schema.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;
using std::chrono::seconds;

JsonSchema schema() {
  return JsonSchema(json::parse(readText(kSource + "/daemon/status/status.schema.json")));
}

std::set<std::string> promises() {
  std::istringstream lines(readText(kSource + "/tests/data/status_promises.txt"));
  std::set<std::string> all;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line[0] != '#') all.insert(line);
  }
  return all;
}

TEST(StatusSchema, KeepsEveryPromiseAndListsEveryMember) {
  const auto promised = promises();
  const auto members = schema().members();
  const std::set<std::string> present(members.begin(), members.end());
  EXPECT_GT(promised.size(), 250U);
  for (const std::string& line : promised) {
    EXPECT_TRUE(present.contains(line))
        << line << ": was promised and is gone or changed; add another member instead";
  }
  for (const std::string& line : present) {
    EXPECT_TRUE(promised.contains(line))
        << line << ": is new; add this line to tests/data/status_promises.txt";
  }
}

TEST(StatusSchema, SaysWhatIsWrong) {
  const JsonSchema s = schema();
  const json good = {
      {"now_ns", 1}, {"time_utc", ""}, {"kind", "wall"}, {"severity", "fault"}, {"what", "x"}};
  EXPECT_TRUE(s.faults("event", good).empty());
  const auto with = [&](const char* name, const json& value) {
    json changed = good;
    changed[name] = value;
    return s.faults("event", changed);
  };
  EXPECT_EQ(with("now_ns", 1.5), std::vector<std::string>{"event/now_ns: is 1.5"});
  EXPECT_EQ(with("why", 1), std::vector<std::string>{"event/why: is not in the schema"});
  json lacking = good;
  lacking.erase("what");
  EXPECT_EQ(s.faults("event", lacking), std::vector<std::string>{"event: has no what"});
  EXPECT_EQ(s.faults("events", {1}), std::vector<std::string>{"events/#: is 1"});
  EXPECT_EQ(s.faults("pointer", {{"at", "sky"}, {"pixel", {1}}, {"at_model_m", {0, 0, 0}}}).size(),
            2U);
}

// Checks several documents of each topic of both roles, while an emulated person uses the devices.
TEST(StatusSchema, MerlindKeepsTo) {
  const TempDir dir;
  const json projectors = json::array({{{"name", "left"}, {"address", "127.0.0.1:1"}}});
  const json schedule = json::array({{{"days", {"mon"}}, {"on", "08:00"}, {"off", "18:00"}}});
  Merlind m(dir, makeModel(dir, 5), "schema",
            {.also = {{"projectors", projectors},
                      {"projector_schedule", schedule},
                      {"gestures", {{"file", kSource + "/config/gestures.json"}}}}});
  ASSERT_TRUE(m.ready()) << m.process().output();
  const JsonSchema s = schema();
  for (const std::string role : {"devices", "wall"}) {
    const std::string at = fmt::format("ipc://{}/{}-{}", dir.path(), m.instance(), role);
    std::map<std::string, int> seen;
    const std::vector<std::string> topics =
        role == "wall" ? std::vector<std::string>{"status", "metrics", "event"}
                       : std::vector<std::string>{"status", "metrics", "event", "sample"};
    const auto followed = status::follow(
        {at + ".status"}, topics, seconds(10),
        [&](const std::string& topic, const std::string& document) {
          const bool shared = topic == "event" || topic == "sample";
          const auto faults = s.faults(shared ? topic : fmt::format("{}_{}", role, topic),
                                       json::parse(document, nullptr, false));
          EXPECT_TRUE(faults.empty()) << role << " " << topic << ":\n"
                                      << fmt::format("{}", fmt::join(faults, "\n"));
          ++seen[topic];
          return faults.empty() && (seen["status"] < 3 || seen["metrics"] < 3);
        });
    EXPECT_TRUE(followed);
    EXPECT_TRUE(role == "wall" || seen["sample"] > 10);
    for (const char* command : {"status", "events"}) {
      const auto answer = status::ask(at + ".command", command, seconds(10));
      ASSERT_TRUE(answer) << answer.error().what;
      const std::string definition = command == std::string("status") ? role + "_status" : command;
      const auto faults = s.faults(definition, json::parse(*answer));
      EXPECT_TRUE(faults.empty()) << fmt::format("{}", fmt::join(faults, "\n"));
    }
  }
  const auto events = status::ask(
      fmt::format("ipc://{}/{}-devices.command", dir.path(), m.instance()), "events", seconds(10));
  EXPECT_FALSE(json::parse(*events).empty()) << "the devices were connected";
}

}  // namespace
}  // namespace merlin::test
