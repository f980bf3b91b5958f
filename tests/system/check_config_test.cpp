// Whatever configuration merlind refuses to start with, --check-config has to refuse with the same
// messages.
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/base/sanitizer.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;

// Returns the lines of `output` that name a place in `file`.
std::string findingsOf(const std::string& output, const std::string& file) {
  std::string found;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(file + ":") && line.find(": /") != std::string::npos) found += line + "\n";
  }
  return found;
}

class CheckConfig : public testing::Test {
 protected:
  // Writes a configuration with which merlind starts, with `patch` merged into it; returns its
  // path.
  std::string file(const json& patch) {
    json config = {{"instance", privateName("check")},
                   {"run_directory", dir_.path()},
                   {"wall", {{"model", model_}}}};
    config.merge_patch(patch);
    writeText(dir_ / "c.json", config.dump(1));
    return dir_ / "c.json";
  }

  void expectRefused(const json& patch, const std::string& pointer, const std::string& what,
                     const std::string& role = "all") {
    SCOPED_TRACE(patch.dump());
    const std::string config = file(patch);
    const Outcome checked = run({kMerlind, "--check-config", config, "--role", role});
    const Outcome started = run({"timeout", "30", kMerlind, "--config", config, "--role", role});
    EXPECT_EQ(checked.status, 2) << checked.output;
    EXPECT_EQ(started.status, 2) << started.output;
    const std::string findings = findingsOf(checked.output, config);
    EXPECT_NE(findings.find(": " + pointer + " "), std::string::npos) << checked.output;
    EXPECT_NE(findings.find(what), std::string::npos) << checked.output;
    EXPECT_EQ(findings, findingsOf(started.output, config));
  }

  void expectAdjusted(const json& patch, const std::string& pointer, const std::string& what) {
    SCOPED_TRACE(patch.dump());
    const std::string config = file(patch);
    const Outcome checked = run({kMerlind, "--check-config", config});
    EXPECT_EQ(checked.status, 1) << checked.output;
    const std::string findings = findingsOf(checked.output, config);
    EXPECT_NE(findings.find(": " + pointer + " "), std::string::npos) << checked.output;
    EXPECT_NE(findings.find(what), std::string::npos) << checked.output;
  }

  TempDir dir_;
  std::string model_ = makeModel(dir_, 2);
};

json pngOutput(const std::string& path) {
  return {{"wall", {{"outputs", json::array({{{"kind", "png"}, {"path", path}}})}}}};
}

TEST_F(CheckConfig, RefusesWallsThatCannotBeDrawn) {
  EXPECT_EQ(run({kMerlind, "--check-config", file(json::object())}).status, 0);
  const auto tiles = [](const json& settings) { return json{{"wall", {{"tiles", settings}}}}; };
  const json far = {{"name", "far"}, {"kind", "wall"}, {"x", 9000}, {"y", 0}, {"turns", 0}};
  expectRefused(tiles({{"tiles", json::array({far})}}), "/wall/tiles/tiles/0",
                "tile far at 9000, 0 does not lie in the frame of 1280 x 960");
  expectRefused(tiles({{"tiles", json::array()}}), "/wall/tiles/tiles",
                "a wall has at least one tile");
  expectRefused(tiles({{"near_m", 5}, {"far_m", 1}}), "/wall/tiles", "0 < near_m < far_m");
  expectRefused({{"wall", {{"scene", {{"tracker_axes", {1, 2, -3}}}}}}}, "/wall/scene/tracker_axes",
                "right-handed");
  expectRefused({{"wall", {{"render", {{"show", "heat"}}}}}}, "/wall/render/show",
                "no feature \"heat\" that can be shown");
  const auto render = [](const json& settings) { return json{{"wall", {{"render", settings}}}}; };
  expectRefused(render({{"gpu", "matrox"}}), "/wall/render/gpu",
                "\"matrox\" is none of the GPUs; this machine has: 0: ");
  expectRefused(render({{"gpu", "0"}, {"backend", "osmesa"}}), "/wall/render/gpu",
                "OSMesa draws in software");
}

// An alarm's program may be installed later, so a missing program is no reason to refuse the other
// alarms.
TEST_F(CheckConfig, SaysThatAnAlarmsProgramCannotBeExecuted) {
  writeText(dir_ / "plain", "#!/bin/sh\n");
  writeText(dir_ / "script", "#!/no/such/sh\n");
  std::filesystem::permissions(dir_ / "script", std::filesystem::perms::owner_all);
  const std::string config = file({{"alarms",
                                    {{{"run", {"/no/such/program"}}},
                                     {{"run", {dir_ / "plain", "argument"}}},
                                     {{"run", {dir_.path()}}},
                                     {{"run", {"/bin/sh", "-c", "true"}}},
                                     {{"run", {dir_ / "script"}}}}}});
  const Outcome checked = run({kMerlind, "--role", "alarms", "--check-config", config});
  EXPECT_EQ(checked.status, 1) << "adjusted: " << checked.output;
  for (const std::string& said :
       {std::string("/alarms/0/run/0 cannot be used: /no/such/program: cannot be executed: No such "
                    "file or directory; until it can be, this alarm tells nobody"),
        "/alarms/1/run/0 cannot be used: " + (dir_ / "plain") + ": cannot be executed: Permission",
        "/alarms/2/run/0 cannot be used: " + dir_.path() + ": cannot be executed: it is not",
        "/alarms/4/run/0 cannot be used: " + (dir_ / "script") +
            ": cannot be executed: its first line names the interpreter /no/such/sh: No such"})
    EXPECT_NE(checked.output.find(said), std::string::npos) << checked.output;
  EXPECT_EQ(checked.output.find("/alarms/3"), std::string::npos) << checked.output;
}

TEST_F(CheckConfig, ModelsThatCannotBeReadAreLeftOut) {
  const auto model = [](const std::string& path) { return json{{"wall", {{"model", path}}}}; };
  expectRefused(model(""), "/wall/model", "names no .mrm file");
  const std::string none = "; the wall is shown without any content until one can be read";
  expectAdjusted(model("none.mrm"), "/wall/model", "none.mrm: No such file or directory" + none);
  expectAdjusted(model("."), "/wall/model", "is not a regular file" + none);
  ASSERT_EQ(::mkfifo((dir_ / "pipe").c_str(), 0600), 0);
  // The check must not block when it opens the pipe.
  expectAdjusted(model("pipe"), "/wall/model", "is not a regular file" + none);
  const json damaged = json::array({{{"model", "c.json"}}});
  expectAdjusted({{"wall", {{"model", ""}, {"contents", damaged}}}}, "/wall/contents/0/model",
                 "c.json: is ");
  const Outcome beside =
      run({kMerlind, "--check-config", file({{"wall", {{"contents", damaged}}}})});
  EXPECT_EQ(beside.status, 1) << "beside a model that can be read; " << beside.output;
  EXPECT_NE(beside.output.find("the wall is shown without it until it can be read"),
            std::string::npos)
      << beside.output;
}

TEST_F(CheckConfig, AStateFileThatCannotBeWrittenKeepsNoWallDark) {
  const std::string kept = "; what people change is not kept until it can be written";
  std::filesystem::create_directory(dir_ / "folder");
  expectAdjusted({{"state_file", "folder"}}, "/state_file", kept);
  ASSERT_EQ(::mkfifo((dir_ / "fifo").c_str(), 0600), 0);
  expectAdjusted({{"state_file", "fifo"}}, "/state_file", kept);
  writeText(dir_ / "plain", "");
  expectAdjusted({{"state_file", "plain/state.json"}}, "/state_file", kept);
}

TEST_F(CheckConfig, RefusesFilesThatCannotBeWritten) {
  writeText(dir_ / "file", "kept");
  expectRefused({{"run_directory", "file"}}, "/run_directory", "file: is not a folder");
  std::filesystem::create_directory(dir_ / "open");
  ASSERT_EQ(::chmod((dir_ / "open").c_str(), 0777), 0);
  expectRefused({{"run_directory", "open"}}, "/run_directory", "can be written to by every user");
  std::filesystem::create_directory_symlink(dir_.path(), dir_ / "link");
  expectRefused({{"run_directory", "link"}}, "/run_directory", "is a link");
  expectRefused({{"run_directory", std::string(100, 'x')}}, "/run_directory", "is too long");
  expectRefused(pngOutput("none/wall.png"), "/wall/outputs/0/path",
                "none/wall.png: No such file or directory");
  expectRefused(pngOutput("."), "/wall/outputs/0/path", "Is a directory");
  expectRefused(pngOutput(model_), "/wall/outputs/0/path", "it would be overwritten");
  expectRefused(pngOutput("file"), "/wall/outputs/0/path", "is not a PNG file");
  expectRefused(pngOutput(std::string("x\0y.png", 7)), "/wall/outputs/0/path",
                "without the character NUL");
  expectRefused({{"wall", {{"snapshots", "file/taken"}}}}, "/wall/snapshots", "Not a directory");
  expectRefused({{"wall", {{"shown", {{"folder", "file/shown"}}}}}}, "/wall/shown/folder",
                "Not a directory");
  EXPECT_EQ(readText(dir_ / "file"), "kept");
}

TEST_F(CheckConfig, RefusesSocketsAndPortsThatCannotBeServed) {
  writeText(dir_ / "file", "kept");
  const auto serve = [](const json& settings) { return json{{"serve", settings}}; };
  expectRefused(serve({{"spnav_socket", "file"}}), "/serve/spnav_socket",
                "is not a socket and is not replaced");
  EXPECT_EQ(readText(dir_ / "file"), "kept");
  expectRefused(serve({{"spnav_socket", "none/s.sock"}}), "/serve/spnav_socket",
                "none: No such file or directory");
  expectRefused(serve({{"spnav_socket", std::string(200, 's')}}), "/serve/spnav_socket",
                "a socket's name has at most 107");
  for (const char* endpoint : {"tcp://*:99999", "tcp://127.0.0.1:0", "tcp://256.1.1.1:7401"}) {
    expectRefused(serve({{"samples_endpoint", endpoint},
                         {"samples_keys", "keys"},
                         {"samples_clients", "clients"}}),
                  "/serve/samples_endpoint", "allowed is tcp://ADDRESS:PORT");
  }
  expectRefused(serve({{"samples_endpoint", "tcp://nohost:7401"},
                       {"samples_keys", "keys"},
                       {"samples_clients", "clients"}}),
                "/serve/samples_keys", "keys: No such file or directory");
  expectRefused(serve({{"samples_endpoint", "tcp://nohost:7401"},
                       {"samples_keys", "keys"},
                       {"samples_clients", "clients"}}),
                "/serve/samples_endpoint", "nohost is neither * nor an IPv4 address");
}

TEST_F(CheckConfig, RefusesPortsThatCannotBePlayed) {
  writeText(dir_ / "bad.bytes", "no transcript\n");
  const auto ball = [](const std::string& port) {
    return onlyDevice(deviceEntry("ball", "spaceball", port));
  };
  expectRefused(ball("replay:" + dir_ / "bad.bytes"), "/devices/0/port", "bad.bytes: line 1");
  expectRefused(ball("replay:" + dir_ / "none"), "/devices/0/port", "No such file");
  expectRefused(ball("tcp://256.1.1.1:99999"), "/devices/0/port", "allowed are serial:");
}

TEST_F(CheckConfig, RefusesTwoNamesOfOneDevice) {
  writeText(dir_ / "event5", "");
  std::filesystem::create_symlink("event5", dir_ / "by-id");
  const auto second = [&](const std::string& port) {
    return json{{"devices", json::array({deviceEntry("a", "evdev", "evdev:" + dir_ / "event5"),
                                         deviceEntry("b", "touch", "evdev:" + port)})}};
  };
  const std::string of_a = "event5, the port of the device \"a\" at /devices/0, \"evdev:";
  expectRefused(second(dir_ / "by-id"), "/devices/1/port", of_a, "devices");
  expectRefused(second(dir_ / "x/../event5"), "/devices/1/port", of_a, "devices");
  const Outcome other =
      run({kMerlind, "--check-config", file(second(dir_ / "event6")), "--role", "devices"});
  EXPECT_EQ(other.status, 0) << other.output;
}

TEST_F(CheckConfig, LooksAtWhatTheRoleNeeds) {
  const std::string config = file({{"wall", {{"model", "none.mrm"}}}});
  EXPECT_EQ(run({kMerlind, "--check-config", config, "--role", "devices"}).status, 0);
  EXPECT_EQ(run({kMerlind, "--check-config", config, "--role", "wall"}).status, 1) << "adjusted";
  const std::string replay = file(onlyDevice(deviceEntry("ball", "spaceball", "replay:none")));
  EXPECT_EQ(run({kMerlind, "--check-config", replay, "--role", "wall"}).status, 0);
}

// The network lacks a posture that the default bindings use. As the file has no bindings of its
// own, this is not its author's mistake.
TEST_F(CheckConfig, ADefaultBindingIsNobodysMistake) {
  std::string network = readText(kSource + "/config/postures.json");
  for (std::size_t at = 0; (at = network.find("\"fist\"", at)) != std::string::npos;)
    network.replace(at, 6, "\"ball\"");
  writeText(dir_ / "own.json", network);
  const json devices = {{"postures", {{"file", "own.json"}}}};
  for (const char* role : {"devices", "all"}) {
    const Outcome checked = run({kMerlind, "--check-config", file(devices), "--role", role});
    EXPECT_EQ(checked.status, 0) << role << ": " << checked.output;
  }
  json bound = devices;
  bound["bindings"] = json::array({{{"input", "posture.fist"}, {"action", "grab"}}});
  expectRefused(bound, "/bindings/0/input", "is not a posture of");
}

TEST_F(CheckConfig, AnEmptyNameIsBadUsageAndStartsNothing) {
  for (const char* option : {"--check-config", "--config"}) {
    const Outcome refused = run({kMerlind, option, ""});
    EXPECT_EQ(refused.status, 2) << option;
    EXPECT_NE(refused.output.find("names no file"), std::string::npos) << refused.output;
  }
}

// If the check itself runs out of memory or ends early, the command must not report "adjusted".
TEST_F(CheckConfig, ACheckThatDoesNotEndIsNotValid) {
  std::string bindings;
  for (int i = 0; i < 340'000; ++i) bindings += i == 0 ? "{}" : ",{}";
  writeText(dir_ / "c.json", "{\"bindings\": [" + bindings + "]}");
  const std::string check = kMerlind + " --check-config " + dir_ / "c.json";
#if !defined(MERLIN_ANY_SANITIZER)
  const Outcome starved = run({"/bin/bash", "-c", "ulimit -v 150000; exec " + check});
  EXPECT_EQ(starved.status, 2) << starved.output;
#endif
  const Outcome whole = run({"/bin/bash", "-c", check});
  EXPECT_EQ(whole.status, 2);
  EXPECT_NE(whole.output.find("more findings"), std::string::npos);
  EXPECT_LT(whole.output.size(), 150'000u);
}

TEST_F(CheckConfig, ACheckWhoseWordsCannotBeWrittenIsNotDone) {
  writeText(dir_ / "bad.json", R"({"bogus": 1})");
  for (const char* where : {">/dev/full", ">&-", "2>/dev/full", "2>&-"}) {
    const Outcome checked =
        run({"/bin/sh", "-c",
             fmt::format("{} --check-config {}/bad.json {}", kMerlind, dir_.path(), where)});
    EXPECT_EQ(checked.status, 2) << where;
  }
  const Outcome few =
      run({"/bin/bash", "-c",
           fmt::format("ulimit -n 64; {} --check-config {}/bad.json", kMerlind, dir_.path())});
  EXPECT_NE(few.output.find("may open 64 files at once"), std::string::npos) << few.output;
}

TEST_F(CheckConfig, FindingsAreLinesThatNoTerminalFollows) {
  writeText(dir_ / "c.json", R"({"\u001b[2Jx": 1, "y\nc.json:9: /forged": 2,
    "instance": "a\u001bb\nc"})");
  const Outcome checked = run({kMerlind, "--check-config", dir_ / "c.json"});
  EXPECT_EQ(checked.status, 2);
  EXPECT_EQ(checked.output.find('\033'), std::string::npos) << checked.output;
  EXPECT_EQ(checked.output.find("\nc.json"), std::string::npos) << checked.output;
  EXPECT_NE(checked.output.find("\\x1b[2Jx"), std::string::npos) << checked.output;
  const Outcome named = run({kMerlind, "--check-config", dir_ / "no\033[31m\nfile"});
  EXPECT_EQ(named.output.find('\033'), std::string::npos);
  EXPECT_NE(named.output.find("no\\x1b[31m\\x0afile: No such file"), std::string::npos)
      << named.output;
}

}  // namespace
}  // namespace merlin::test
