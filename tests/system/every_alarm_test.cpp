// Raises each documented kind of alarm once with real programs. A fault happens at a real merlind,
// and a real merlind --role alarms starts a program that is configured for that kind alone.
#include <array>
#include <filesystem>
#include <functional>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "daemon/base/event_kinds.h"
#include "daemon/base/unique_fd.h"
#include "daemon/net/connection_server.h"
#include "tests/support/emulated_projector.h"
#include "tests/system/blacken.h"
#include "tests/system/merlind.h"
#include "tests/system/told.h"

namespace merlin::test {
namespace {

using Json = nlohmann::json;
using namespace std::chrono_literals;

// The merlind of a test, whatever else its fault needs, and the alarms' process. The alarms'
// process does not report what happened before it began to follow a role. The test therefore causes
// a harmless change of the role first, and causes the fault only when that change has been
// reported.
struct Stage {
  TempDir dir;
  ProjectorServer projector;
  std::vector<UniqueFd> held;
  int vrpn_port = 0;
  std::string model = dir / "model.mrm";
  std::unique_ptr<Merlind> merlind;
  std::unique_ptr<Process> alarms;
  std::unique_ptr<Process> again;  // a restarted merlind

  std::string file(const std::string& name) const { return dir / name; }
};

// A kind of alarm and how to raise it. `act` is called repeatedly until the alarm is raised; each
// call may do something new.
struct Row {
  const char* kind;
  const char* says;  // part of the alarm's sentence
  const char* role;  // the role of merlind in which the fault is
  std::function<Json(Stage&)> also;
  std::function<void(Stage&)> act;
  const char* which = "";  // distinguishes several rows of the same kind
};

void PrintTo(const Row& row, std::ostream* out) { *out << row.kind; }

Json nothing(Stage&) { return Json::object(); }

Json outputs(const Json& list) { return {{"wall", {{"outputs", list}}}}; }

Json checkedOutput(Stage&) { return outputs({{{"kind", "shared_memory"}, {"check_s", 0.2}}}); }

// With a playlist the picture changes, so that files of it are written.
Json fileOutput(Stage& stage) {
  std::filesystem::create_directories(stage.file("png"));
  Json also = outputs({{{"kind", "png"}, {"path", stage.file("png/wall.png")}, {"interval_s", 1}}});
  also["wall"]["playlist"] = {{"after_s", 1}};
  return also;
}

Json oneProjector(Stage& stage) {
  return {{"projectors", {{{"name", "left"}, {"address", "127.0.0.1:" + stage.projector.port}}}}};
}

Json vrpn(Stage& stage) {
  const auto probe = net::listenTcp("127.0.0.1", 0);
  stage.vrpn_port = probe ? net::portOf(probe->get()) : 0;
  return {{"serve", {{"vrpn_port", stage.vrpn_port}}}};
}

// The VRPN server's port is in use by another program from the start.
Json takenVrpn(Stage& stage) {
  auto taken = net::listenTcp("127.0.0.1", 0);
  if (!taken) return Json::object();
  stage.vrpn_port = net::portOf(taken->get());
  stage.held.push_back(*std::move(taken));
  return {{"serve", {{"vrpn_port", stage.vrpn_port}}}};
}

void killTheBall(Stage& stage) {
  for (const pid_t pid : stage.merlind->children("spaceball")) ::kill(pid, SIGKILL);
}

void removeFolderOfFiles(Stage& stage) { std::filesystem::remove_all(stage.file("png")); }

void blackenFrame(Stage& stage) { blacken(stage.merlind->instance()); }

void damageModel(Stage& stage) {
  if (std::filesystem::exists(stage.file("damaged"))) return;
  writeText(stage.file("damaged"), "no model");
  writeText(stage.file("new.mrm"), "this is no model");
  std::filesystem::rename(stage.file("new.mrm"), stage.model);
}

void reloadNonsense(Stage& stage) {
  writeText(stage.merlind->config(), "{\"no_such_key\": 1}");
  ::kill(stage.merlind->process().pid(), SIGHUP);
}

void removeSharedMemory(Stage& stage) {
  if (std::filesystem::exists(stage.file("removed"))) return;
  writeText(stage.file("removed"), "shared memory");
  std::filesystem::remove("/dev/shm/" + stage.merlind->instance() + "-devices");
}

// Connects more clients than the VRPN server has places for.
void crowdVrpn(Stage& stage) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(stage.vrpn_port));
  while (stage.held.size() < 300) {
    UniqueFd client(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    if (::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      return;
    stage.held.push_back(std::move(client));
  }
}

// Events that merlind reports while it starts, before any program can follow it, raise alarms too.
void restartWithDamagedState(Stage& stage) {
  if (stage.again) return;
  EXPECT_EQ(stage.merlind->process().kill(SIGTERM), 0);
  writeText(stage.file("alarm.state.json"), "{");
  stage.again = std::make_unique<Process>(
      std::vector<std::string>{kMerlind, "--config", stage.merlind->config(), "--role", "wall"});
}

const std::vector<Row>& rows() {
  static const std::vector<Row> all = {
      {"device", "ball: ", "devices", nothing, killTheBall},
      {"wall", "output png failed: ", "wall", fileOutput, removeFolderOfFiles},
      {"picture", "is black instead of what was meant", "wall", checkedOutput, blackenFrame},
      {"model", "model.mrm", "wall", nothing, damageModel},
      {"projector", "projector left: unknown, ", "devices", oneProjector,
       [](Stage& stage) { stage.projector.vanish(); }},
      {"service", "configuration: failed (", "devices", nothing, reloadNonsense},
      {"service", "shared memory: failed (", "devices", nothing, removeSharedMemory,
       "shared_memory"},
      {"server", " refused or closed", "devices", vrpn, crowdVrpn},
      {"server", "VRPN: failed (", "devices", takenVrpn, [](Stage&) {}, "taken_port"},
      {"state", "the state file is damaged", "wall", nothing, restartWithDamagedState},
      {"flight", "ball", "devices", nothing, killTheBall},
      {"role", "has not run for 15 s", "devices", nothing,
       [](Stage& stage) { ::kill(stage.merlind->process().pid(), SIGKILL); }},
  };
  return all;
}

class EveryAlarm : public testing::TestWithParam<Row> {
 protected:
  // Returns a configuration with one alarm for this kind, and one for the harmless change.
  Json alarmsFor(const Row& row) {
    const auto program = [this](const std::string& file) {
      return Json{"/bin/sh", "-c", "cat >> \"$0\"", stage_.file(file)};
    };
    return {{{"run", program("told")}, {"kinds", {row.kind}}, {"most_per_hour", 3600}},
            {{"run", program("probed")}, {"kinds", {"service"}}, {"most_per_hour", 3600}}};
  }

  void startMerlind(const Row& row) {
    MerlindOptions options;
    options.role = row.role;
    options.emulate = options.role == "devices";
    options.also = row.also(stage_);
    options.also["alarms"] = alarmsFor(row);
    stage_.merlind = std::make_unique<Merlind>(stage_.dir, stage_.model, "alarm", options);
  }

  void startAlarms() {
    stage_.alarms = std::make_unique<Process>(std::vector<std::string>{
        kMerlind, "--config", stage_.merlind->config(), "--role", "alarms"});
    ASSERT_TRUE(stage_.alarms->saysEventually("ready")) << stage_.alarms->output();
  }

  // Causes the harmless change: a configuration that is refused and then accepted gives two events
  // of each role. The test waits for both before it causes the next two, since the log suppresses
  // frequent repetitions and reload() reads the log.
  bool followsRole() {
    const std::string good = readText(stage_.merlind->config());
    bool said = true;
    const bool follows = eventually([&] {
      said = said && reload("{\"no_such_key\": 1}", "configuration: failed (") &&
             reload(good, "configuration: works again");
      return !said || eventually([&] { return !told(stage_.file("probed")).empty(); }, 2s);
    });
    return said && follows;
  }

  // Lets merlind read the configuration again, and waits until it reports the outcome.
  bool reload(const std::string& text, const std::string& says) {
    Process& merlind = stage_.merlind->process();
    const std::size_t before = merlind.output().size();
    writeText(stage_.merlind->config(), text);
    ::kill(merlind.pid(), SIGHUP);
    return eventually([&] { return merlind.output().find(says, before) != std::string::npos; });
  }

  bool isTold(const Row& row) {
    return eventually(
        [&] {
          row.act(stage_);
          for (const Json& event : told(stage_.file("told"))) {
            if (event.is_object() &&
                event["what"].get<std::string>().find(row.says) != std::string::npos)
              return true;
          }
          return false;
        },
        60s);
  }

  Stage stage_;
};

TEST_P(EveryAlarm, IsToldToTheProgramThatIsForIt) {
  const Row& row = GetParam();
  if (std::string_view(row.role) == "wall")
    std::filesystem::rename(makeModel(stage_.dir, 2), stage_.model);
  startMerlind(row);
  ASSERT_TRUE(stage_.merlind->ready()) << stage_.merlind->process().output();
  if (std::string_view(row.role) == "devices") {
    ASSERT_TRUE(stage_.merlind->healthIs("ball", HealthState::kOk));
  }
  startAlarms();
  ASSERT_TRUE(followsRole()) << stage_.alarms->output() << stage_.merlind->process().output();
  EXPECT_TRUE(isTold(row)) << readText(stage_.file("told")) << stage_.merlind->process().output();
  for (const Json& event : told(stage_.file("told"))) {
    EXPECT_EQ(event["kind"], row.kind);
    EXPECT_EQ(event["instance"], stage_.merlind->instance());
    EXPECT_EQ(event["role"], std::string_view(row.kind) == "role" ? "alarms" : row.role);
  }
  EXPECT_EQ(stage_.alarms->output().find("most_per_hour"), std::string::npos)
      << "nothing had to wait for that\n"
      << stage_.alarms->output();
}

std::string kindOf(const testing::TestParamInfo<Row>& of) {
  return of.param.kind + std::string(*of.param.which ? "_" : "") + of.param.which;
}

INSTANTIATE_TEST_SUITE_P(OfTheDocuments, EveryAlarm, testing::ValuesIn(rows()), kindOf);

// Returns the kinds that the alarms' documentation lists in the first column of its table.
std::set<std::string> documented() {
  const std::string page = readText(kSource + "/daemon/alarms/README.md");
  std::istringstream lines(page.substr(page.find("## What each kind means")));
  std::set<std::string> kinds;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("| `")) kinds.insert(line.substr(3, line.find('`', 3) - 3));
  }
  return kinds;
}

TEST(EveryAlarmOfTheDocuments, HasARowInThisTestAndNoRowIsOfAnother) {
  std::set<std::string> known, tested;
  for (const EventKind& kind : kEventKinds) known.insert(kind.name);
  for (const Row& row : rows()) tested.insert(row.kind);
  EXPECT_EQ(tested, known) << "kinds that alarms can be for: daemon/base/event_kinds.h";
  EXPECT_EQ(tested, documented()) << "kinds that daemon/alarms/README.md describes";
}

}  // namespace
}  // namespace merlin::test
