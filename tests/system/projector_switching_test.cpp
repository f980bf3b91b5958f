// A real merlind and emulated projectors that speak PJLink at TCP ports of this machine: commands,
// the schedule, warm-up, a wrong password, a projector that vanishes, and restarts.
#include <memory>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/status/client.h"
#include "render/panel/panel_layout.h"
#include "tests/support/emulated_projector.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using json = nlohmann::json;

class ProjectorSwitching : public testing::Test {
 protected:
  // The emulated projectors warm up and cool down quickly, so that the test is short.
  ProjectorSwitching() {
    for (ProjectorServer* server : {&left_, &right_})
      server->set([](auto& p) { p.warm_up = p.cool_down = std::chrono::seconds(1); });
  }

  void start(const json& more = json::object()) {
    json also = {{"projectors",
                  {{{"name", "left"}, {"address", "127.0.0.1:" + left_.port}},
                   {{"name", "right"}, {"address", "127.0.0.1:" + right_.port}}}}};
    also.merge_patch(more);
    m_ = std::make_unique<Merlind>(
        dir_, "", "projectors", MerlindOptions{.role = "devices", .emulate = false, .also = also});
    ASSERT_TRUE(m_->ready()) << m_->process().output();
  }
  Outcome merlin(const std::string& command) {
    return run({kMerlin, command, "--instance", m_->instance()});
  }
  json projector(const std::string& name) {
    const json status = m_->status();
    return status.is_object() && status.contains("projectors")
               ? status["projectors"].value(name, json::object())
               : json::object();
  }
  // Waits until the projector is in the expected state.
  bool is(const std::string& name, const std::string& power) {
    return eventually([&] {
      const json p = projector(name);
      return p.value("power", "") == power && p.value("wanted", "?").empty();
    });
  }
  bool hasHealth(const std::string& name, const std::string& health) {
    return eventually([&] { return projector(name).value("health", "") == health; });
  }

  TempDir dir_;
  ProjectorServer left_, right_;
  std::unique_ptr<Merlind> m_;
};

TEST_F(ProjectorSwitching, ByCommandAllAtOnceAndStatusShowsThem) {
  start();
  EXPECT_TRUE(is("left", "off") && is("right", "off"));
  const Outcome on = merlin("projector_on");
  EXPECT_EQ(on.status, 0) << on.output;
  EXPECT_TRUE(is("left", "on") && is("right", "on"));
  const Outcome shown = run({kMerlin, "status", "--instance", m_->instance()});
  EXPECT_NE(shown.output.find("projector left          on       ok           Epsilon, lamp 1234 h"),
            std::string::npos)
      << shown.output;
  EXPECT_TRUE(m_->process().saysEventually("projector right: on, ok"));
  EXPECT_EQ(merlin("projector_off").status, 0);
  EXPECT_TRUE(is("left", "off") && is("right", "off"));
  left_.vanish();
  EXPECT_EQ(left_.projector.log, "10");
}

// Runs the roles as systemd does, with the wall in a process of its own.
TEST_F(ProjectorSwitching, ThePanelOfAWallInAnotherProcessSwitchesThem) {
  start();
  EXPECT_TRUE(is("left", "off") && is("right", "off"));
  json config = json::parse(readText(m_->config()));
  config["wall"] = {
      {"model", makeModel(dir_, 5)}, {"rate", {{"rate_hz", 10}}}, {"operator", {{"panel", true}}}};
  writeText(dir_ / "wall.json", config.dump());
  Process wall({kMerlind, "--config", dir_ / "wall.json", "--role", "wall"});
  ASSERT_TRUE(wall.saysEventually("ready")) << wall.output();
  render::panel::PanelOptions options;
  options.projectors = true;
  const auto layout = *render::panel::layOutPanel(640, 480, 13, options);
  const auto press = [&](render::panel::ControlId id) {
    const render::text::Rect r = layout.find(id)->at;
    // The operator's tile is the lower right one of the default wall.
    const int x = 640 + layout.at.x + r.x + r.width / 2, y = 480 + layout.at.y + r.y + r.height / 2;
    for (const int button : {0, 1, 0}) {
      const auto pointed = status::ask(
          fmt::format("ipc://{}/{}-wall.command", dir_.path(), m_->instance()), "operator_pointer",
          std::chrono::seconds(10), fmt::format("{} {} {}", x, y, button));
      EXPECT_TRUE(pointed) << pointed.error().what;
    }
  };
  press(render::panel::ControlId::kProjectorsOn);
  EXPECT_TRUE(is("left", "on") && is("right", "on")) << wall.output();
  // The devices' process has ended, so nobody answers: the panel reports this, and the wall goes
  // on.
  EXPECT_EQ(m_->process().kill(SIGTERM), 0);
  const auto shown =
      shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(m_->instance(), "wall"));
  ASSERT_TRUE(shown);
  const std::uint64_t frames = (*shown)->stats.read()->frames;
  press(render::panel::ControlId::kProjectorsOff);
  EXPECT_TRUE(eventually([&] { return (*shown)->stats.read()->frames > frames; }));
  EXPECT_EQ(wall.kill(SIGTERM), 0) << wall.output();
  left_.vanish();
  EXPECT_EQ(left_.projector.log, "1");
}

TEST_F(ProjectorSwitching, OneThatWarmsUpIsNotSwitchedOffBeforeItIsOn) {
  left_.set([](auto& p) { p.warm_up = std::chrono::hours(1); });
  start();
  EXPECT_TRUE(is("left", "off"));
  merlin("projector_on");
  EXPECT_TRUE(eventually([&] { return projector("left").value("power", "") == "warming"; }));
  const Outcome off = merlin("projector_off");
  EXPECT_EQ(off.status, 0) << off.output;
  left_.set([](auto& p) { p.endPhase(); });
  EXPECT_TRUE(is("left", "off"));
  left_.vanish();
  EXPECT_EQ(left_.projector.log, "10")
      << "one that was sent meanwhile had been refused, and counted";
}

TEST_F(ProjectorSwitching, AWrongPasswordIsSaidAndTheRightOneFromThenOnUsed) {
  ProjectorServer locked("JBMIAProjectorLink");
  locked.set([](auto& p) { p.warm_up = std::chrono::seconds(0); });
  writeText(dir_ / "password", "guess\n");
  start({{"projectors",
          {{{"name", "left"},
            {"address", "127.0.0.1:" + locked.port},
            {"password_file", dir_ / "password"}},
           {{"name", "right"}, {"address", "127.0.0.1:" + right_.port}}}}});
  EXPECT_TRUE(hasHealth("left", "wrong_password"));
  const Outcome refused = merlin("projector_on");
  EXPECT_NE(refused.status, 0);
  EXPECT_NE(refused.output.find("left: "), std::string::npos) << refused.output;
  EXPECT_NE(refused.output.find("it is switched on when it answers"), std::string::npos)
      << refused.output;
  EXPECT_TRUE(is("right", "on")) << "the other one is switched all the same";
  EXPECT_EQ(m_->process().output().find("guess"), std::string::npos) << "in no log";
  writeText(dir_ / "password", "JBMIAProjectorLink\n");
  merlin("projector_on");  // merlind tries the command at once
  EXPECT_TRUE(is("left", "on"));
}

TEST_F(ProjectorSwitching, OneThatVanishesIsSwitchedWhenItIsBack) {
  start();
  merlin("projector_on");
  EXPECT_TRUE(is("left", "on") && is("right", "on"));
  left_.vanish();
  EXPECT_TRUE(hasHealth("left", "unreachable"));
  const Outcome off = merlin("projector_off");
  EXPECT_NE(off.status, 0);
  EXPECT_NE(off.output.find("Connection refused; it is switched off when it answers"),
            std::string::npos)
      << off.output;
  EXPECT_EQ(off.output.find("right"), std::string::npos) << off.output;
  EXPECT_TRUE(is("right", "off"));
  EXPECT_EQ(projector("left").value("wanted", ""), "off");
  left_.appear();
  EXPECT_TRUE(is("left", "off"));
  EXPECT_TRUE(hasHealth("left", "ok"));
}

// Returns a schedule that is on at all times, so that the test does not depend on the time of day.
json alwaysOn() {
  return {{"projector_schedule",
           {{{"on", "00:00"}, {"off", "12:00"}}, {{"on", "12:00"}, {"off", "00:00"}}}}};
}

TEST_F(ProjectorSwitching, ByTheScheduleUnlessAPersonDidOtherwiseBeforeTheRestart) {
  start(alwaysOn());
  EXPECT_TRUE(is("left", "on") && is("right", "on")) << "merlind follows the schedule at once";
  EXPECT_TRUE(m_->process().saysEventually("projectors: switched on by the schedule"));
  EXPECT_EQ(merlin("projector_off").status, 0);
  EXPECT_TRUE(is("left", "off") && is("right", "off"));
  for (const int signal : {SIGTERM, SIGKILL}) {
    m_->process().kill(signal);
    start(alwaysOn());
    EXPECT_TRUE(m_->process().saysEventually("switched off again, as by a person before"));
    EXPECT_TRUE(is("left", "off") && is("right", "off"));
  }
  left_.vanish();
  EXPECT_EQ(left_.projector.log, "10") << "and never on again";
}

}  // namespace
}  // namespace merlin::test
