// User errors: each gives one clear message and the right exit status, and leaves no file behind.
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/base/sanitizer.h"
#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

void expectOutcome(const Outcome& outcome, int status, const std::vector<std::string>& parts) {
  EXPECT_EQ(outcome.status, status) << outcome.output;
  for (const std::string& part : parts)
    EXPECT_NE(outcome.output.find(part), std::string::npos)
        << "\"" << part << "\" is not in: " << outcome.output;
}

class BadInput : public testing::Test {
 protected:
  TempDir dir_;
};

TEST_F(BadInput, AModelThatIsNoneIsSaidAndShownOnceItIsThere) {
  writeText(dir_ / "model.mrm", std::string(500, 'x'));
  Merlind m(dir_, dir_ / "model.mrm", "none", {.emulate = false});
  ASSERT_TRUE(m.process().saysEventually("ready")) << m.process().output();
  EXPECT_NE(m.process().output().find("is not an .mrm file (make one with: merlin mesh reduce"),
            std::string::npos)
      << m.process().output();
  const auto status = [&] {
    return nlohmann::json::parse(
        run({kMerlin, "status", "--json", "--instance", m.instance()}).output, nullptr, false);
  };
  EXPECT_TRUE(status().contains("missing_contents")) << status();
  std::filesystem::rename(makeModel(dir_, 5), dir_ / "model.mrm");
  EXPECT_TRUE(m.process().saysEventually("model.mrm can be read now")) << m.process().output();
  EXPECT_TRUE(eventually([&] { return !status().contains("missing_contents"); })) << status();
}

TEST_F(BadInput, ATruncatedScan) {
  const std::string whole = readText(kSource + "/config/models/ankylosaurus.ply");
  writeText(dir_ / "cut.ply", whole.substr(0, whole.size() / 2));
  expectOutcome(run({kMerlin, "mesh", "reduce", dir_ / "cut.ply", "-o", dir_ / "out.mrm"}), 2,
                {"cut.ply: cut short: the header declares 34820 x vertex, the file ends after "
                 "33644 at most"});
  EXPECT_FALSE(std::filesystem::exists(dir_ / "out.mrm"));
}

#if !defined(MERLIN_ANY_SANITIZER)
TEST_F(BadInput, ALimitOfTheAddressSpaceCountsAsWhatIsFree) {
  const std::string reduce = fmt::format("{} mesh reduce {}/config/models/ankylosaurus.ply -o {}",
                                         kMerlin, kSource, dir_ / "out.mrm");
  expectOutcome(run({"/bin/bash", "-c", "ulimit -v 80000; " + reduce}), 2,
                {"even in blocks; the limit (--memory, by default the free memory) is"});
}
#endif

TEST_F(BadInput, AFileThatMayNotGrowSoFar) {
  const std::string reduce = fmt::format("{} mesh reduce {}/config/models/ankylosaurus.ply -o {}",
                                         kMerlin, kSource, dir_ / "out.mrm");
  expectOutcome(run({"/bin/bash", "-c", "ulimit -f 200; " + reduce}), 1,
                {"out.mrm", "File too large"});
  EXPECT_TRUE(std::filesystem::is_empty(dir_ / ""));
}

TEST_F(BadInput, AConfigurationWithThreeErrors) {
  writeText(dir_ / "bad.json",
            "{\n\"wall\": {\n\"modle\": \"a.mrm\",\n\"rate\": {\"rate_hz\": "
            "\"fast\"}},\n\"devices\": [{\"driver\": \"spaceball\", \"port\": \"COM1\"}]\n}\n");
  const std::vector<std::string> findings = {
      "bad.json:3: /wall/modle is not a known setting; did you mean \"model\"?",
      "bad.json:4: /wall/rate/rate_hz is the string \"fast\"; allowed is a number",
      "bad.json:5: /devices/0/port is \"COM1\"; allowed are"};
  expectOutcome(run({kMerlind, "--check-config", dir_ / "bad.json"}), 2, findings);
  expectOutcome(run({kMerlind, "--config", dir_ / "bad.json"}), 2, findings);
}

TEST_F(BadInput, CheckConfigSaysValidAdjustedOrInvalid) {
  writeText(dir_ / "good.json", "{}");
  writeText(dir_ / "adjusted.json", "{\"wall\": {\"rate\": {\"rate_hz\": 100000}}}");
  expectOutcome(run({kMerlind, "--check-config", dir_ / "good.json", "--role", "devices"}), 0,
                {"good.json: valid"});
  expectOutcome(run({kMerlind, "--check-config", dir_ / "adjusted.json", "--role", "devices"}), 1,
                {"is 100000; allowed is 1 to 240; 240 is used"});
  expectOutcome(run({kMerlind, "--check-config", dir_ / "none.json"}), 2,
                {"none.json: No such file or directory"});
}

TEST_F(BadInput, APortThatDoesNotExistLeavesTheRestRunning) {
  const std::string model = makeModel(dir_, 5);
  const std::string name = privateName("noport");
  writeText(dir_ / "c.json",
            nlohmann::json{{"instance", name},
                           {"run_directory", dir_.path()},
                           {"wall", {{"model", model}}},
                           {"devices",
                            {deviceEntry("ball", "spaceball", "serial:/dev/ttyNONE7"),
                             deviceEntry("tracker", "fastrak"),
                             deviceEntry("glove", "cyberglove", "pty:" + dir_ / "none")}}}
                .dump());
  Process merlind({kMerlind, "--config", dir_ / "c.json"});
  EXPECT_TRUE(merlind.saysEventually("ready")) << merlind.output();
  EXPECT_TRUE(merlind.saysEventually("ball: absent (/dev/ttyNONE7: No such file or directory)"))
      << merlind.output();
  EXPECT_TRUE(merlind.saysEventually("glove: absent (" + dir_ / "none: No such file or directory)"))
      << merlind.output();
  EXPECT_TRUE(merlind.saysEventually("tracker: absent (not configured)")) << merlind.output();
  EXPECT_EQ(merlind.kill(SIGTERM), 0);
}

TEST_F(BadInput, APortThatIsNoSerialLine) {
  const std::string name = privateName("noline");
  writeText(dir_ / "file", "");
  writeText(dir_ / "c.json",
            nlohmann::json{{"instance", name},
                           {"run_directory", dir_.path()},
                           {"devices",
                            {deviceEntry("ball", "spaceball", "serial:/dev/null"),
                             deviceEntry("glove", "cyberglove", "pty:" + dir_ / "file")}}}
                .dump());
  Process merlind({kMerlind, "--config", dir_ / "c.json", "--role", "devices"});
  EXPECT_TRUE(merlind.saysEventually("/dev/null: ")) << merlind.output();
  EXPECT_TRUE(merlind.saysEventually("is not a terminal; pty: takes the path of a pseudo-terminal"))
      << merlind.output();
  EXPECT_EQ(merlind.kill(SIGTERM), 0);
}

TEST_F(BadInput, ABrokenPostureNetwork) {
  writeText(dir_ / "p.json", "{\"version\": 1}");
  writeText(dir_ / "c.json", nlohmann::json{{"instance", privateName("net")},
                                            {"run_directory", dir_.path()},
                                            {"postures", {{"file", "p.json"}}}}
                                 .dump());
  expectOutcome(run({kMerlind, "--config", dir_ / "c.json", "--role", "devices"}), 2, {"p.json"});
}

TEST_F(BadInput, BindingsToPosturesThatTheNetworkDoesNotKnow) {
  const std::string postures = kSource + "/config/postures.json";
  writeText(dir_ / "c.json", "{\"postures\": {\"file\": \"" + postures + R"("},
    "bindings": [
      {"input": "posture.fist", "action": "grab"},
      {"input": "posture.pinhc", "action": "next_mode"},
      {"input": "posture.salute", "action": "reset_view"}]})");
  const std::vector<std::string> said = {
      "c.json:4: /bindings/1/input is \"posture.pinhc\", which is not a posture of " + postures +
          "; did you mean \"pinch\"? it knows ",
      "c.json:5: /bindings/2/input is \"posture.salute\", which is not a posture of " + postures +
          "; it knows ",
      "thumb-up"};
  expectOutcome(run({kMerlind, "--check-config", dir_ / "c.json"}), 2, said);
  expectOutcome(run({kMerlind, "--config", dir_ / "c.json"}), 2, said);
  writeText(dir_ / "n.json", R"({"postures": {
    "file": "none.json"}})");
  expectOutcome(run({kMerlind, "--check-config", dir_ / "n.json"}), 2,
                {"n.json:2: /postures/file cannot be used: ", "none.json: No such file"});
  // A process that only draws the wall does not load the posture network.
  const Outcome wall = run({kMerlind, "--check-config", dir_ / "n.json", "--role", "wall"});
  EXPECT_EQ(wall.output.find("/postures/file"), std::string::npos) << wall.output;
}

TEST_F(BadInput, BindingsToGesturesThatTheFileDoesNotKnow) {
  const std::string gestures = kSource + "/config/gestures.json";
  writeText(dir_ / "c.json", "{\"gestures\": {\"file\": \"" + gestures + R"("},
    "bindings": [
      {"input": "gesture.push", "action": "next_content"},
      {"input": "hand.gesture.swipe_lef", "action": "next_mode"}]})");
  const std::vector<std::string> said = {
      "c.json:4: /bindings/1/input is \"hand.gesture.swipe_lef\", which is not a gesture of " +
      gestures + "; did you mean \"swipe_left\"? it knows circle_clockwise, "};
  expectOutcome(run({kMerlind, "--check-config", dir_ / "c.json"}), 2, said);
  expectOutcome(run({kMerlind, "--config", dir_ / "c.json"}), 2, said);
  writeText(dir_ / "n.json", R"({"gestures": {
    "file": "none.json"}})");
  expectOutcome(run({kMerlind, "--check-config", dir_ / "n.json"}), 2,
                {"n.json:2: /gestures/file cannot be used: ", "none.json: No such file"});
  writeText(dir_ / "b.json", R"({"bindings": [
    {"input": "gesture.push", "action": "next_content"}]})");
  expectOutcome(run({kMerlind, "--check-config", dir_ / "b.json"}), 2,
                {"b.json:2: /bindings/0/input is \"gesture.push\", but no gesture is recognised: "
                 "name a file of gestures in /gestures/file"});
}

TEST_F(BadInput, BindingsToKeysThatTheKernelDoesNotKnow) {
  writeText(dir_ / "c.json", R"({"devices": [{"name": "pad", "driver": "evdev"}], "bindings": [
      {"input": "pad.key.space", "action": "next_mode"},
      {"input": "pad.key.spcae", "action": "reset_view"},
      {"input": "button.souht", "action": "blank"},
      {"input": "button.north", "with": "button.zzzzzzzz", "action": "freeze"}]})");
  const std::vector<std::string> said = {
      "c.json:3: /bindings/1/input is \"pad.key.spcae\", and the kernel knows no key of that name; "
      "did you mean \"key.space\"?",
      "c.json:4: /bindings/2/input is \"button.souht\", and the kernel knows no button of that "
      "name; did you mean \"button.south\"?",
      "c.json:5: /bindings/3/with is \"button.zzzzzzzz\", and the kernel knows no button of that "
      "name; `merlin devices` lists those of what is plugged in"};
  expectOutcome(run({kMerlind, "--check-config", dir_ / "c.json"}), 2, said);
}

TEST_F(BadInput, ButtonsOfInputDevicesThatTheKernelDoesNotKnow) {
  writeText(dir_ / "c.json",
            R"({"devices": [{"name": "pad", "driver": "evdev", "evdev": {"buttons": [
      "pagedown", "tl2",
      "sout",
      "btn_east",
      "kp_plus",
      "zzzzzzzz"]}}]})");
  const std::string unknown = ", and the kernel knows no key of that name; ";
  const std::vector<std::string> said = {
      "c.json:3: /devices/0/evdev/buttons/2 is \"sout\"" + unknown + "did you mean \"south\"?",
      "c.json:4: /devices/0/evdev/buttons/3 is \"btn_east\"" + unknown + "did you mean \"east\"?",
      "c.json:5: /devices/0/evdev/buttons/4 is \"kp_plus\"" + unknown + "did you mean \"kpplus\"?",
      "c.json:6: /devices/0/evdev/buttons/5 is \"zzzzzzzz\"" + unknown +
          "`merlin devices` lists those of what is plugged in"};
  const Outcome o = run({kMerlind, "--check-config", dir_ / "c.json"});
  expectOutcome(o, 2, said);
  EXPECT_EQ(o.output.find("pagedown"), std::string::npos) << o.output;
  EXPECT_EQ(o.output.find("tl2"), std::string::npos) << o.output;
}

TEST_F(BadInput, AFullStandardOutputIsAFailure) {
  for (const char* command : {"mesh info config/models/ankylosaurus.ply", "--help"}) {
    const Outcome o =
        run({"sh", "-c", "cd " + kSource + "; " + kMerlin + " " + command + " > /dev/full"});
    EXPECT_EQ(o.status, 1) << command << o.output;
    EXPECT_NE(o.output.find("No space left on device"), std::string::npos) << o.output;
  }
}

TEST_F(BadInput, KeysNeverReplaceWhatIsThere) {
  std::filesystem::create_symlink(dir_ / "nowhere", dir_ / "link");
  const Outcome o = run({kMerlin, "keys", "-o", dir_ / "link"});
  EXPECT_EQ(o.status, 2) << o.output;
  EXPECT_FALSE(std::filesystem::exists(dir_ / "nowhere"));
}

// A killed writer leaves no temporary file; the next writer removes what an earlier one left.
TEST_F(BadInput, AWriterThatIsKilledLeavesNothing) {
  writeText(dir_ / "x.mrm.999999999.tmp", "left by one that is no more");
  Process writer({kMerlin, "mesh", "reduce", kSource + "/config/models/ankylosaurus.ply", "-o",
                  dir_ / "x.mrm"});
  EXPECT_TRUE(writer.saysEventually("%"));
  writer.kill(SIGTERM);
  EXPECT_EQ(run({kMerlin, "mesh", "reduce", kSource + "/config/models/ankylosaurus.ply", "-o",
                 dir_ / "x.mrm"})
                .status,
            0);
  for (const auto& entry : std::filesystem::directory_iterator(dir_.path()))
    EXPECT_EQ(entry.path().string().find(".tmp"), std::string::npos) << entry.path();
}

TEST_F(BadInput, UsageErrorsExitWithTwo) {
  expectOutcome(run({kMerlin}), 2, {"needs a command"});
  expectOutcome(run({kMerlin, "dance"}), 2, {"dance"});
  expectOutcome(run({kMerlin, "snapshot"}), 2, {"-o"});
  expectOutcome(run({kMerlin, "emulate", "theremin"}), 2, {"theremin", "spaceball"});
  expectOutcome(run({kMerlin, "emulate", "spaceball", "--model", "9000"}), 2,
                {"9000", "2003|1003|3003|4000"});
  expectOutcome(run({kMerlind, "--role", "emperor"}), 2, {"emperor"});
  expectOutcome(run({kMerlin, "--help"}), 0, {"status", "mesh", "emulate"});
}

TEST_F(BadInput, NumbersBeyondWhatThereIs) {
  for (const char* baud : {"0", "-1", "31337"}) {
    expectOutcome(run({kMerlin, "emulate", "spaceball", "--baud", baud}), 2, {"--baud", "9600"});
    expectOutcome(run({kMerlin, "record", "pty:x", "-o", dir_ / "r", "--baud", baud}), 2,
                  {"--baud", "9600"});
  }
  expectOutcome(run({kMerlin, "emulate", "spaceball", "--garbage-every", "-1"}), 2,
                {"--garbage-every"});
  for (const char* seconds : {"0", "-1", "nan", "inf"}) {
    expectOutcome(run({kMerlin, "watch", "--for", seconds}), 2, {"--for", seconds});
    expectOutcome(run({kMerlin, "shm", "dump", "--follow", seconds}), 2, {"--follow", seconds});
    expectOutcome(run({kMerlin, "record", "pty:x", "-o", dir_ / "r", "--seconds", seconds}), 2,
                  {"--seconds", seconds});
  }
}

TEST_F(BadInput, CommandsForADaemonThatIsNotThere) {
  const std::string nobody = privateName("nobody");
  expectOutcome(run({kMerlin, "status", "--instance", nobody}), 1, {"no merlind runs as", nobody});
  expectOutcome(run({kMerlin, "watch", "--instance", nobody}), 1, {"no merlind runs as"});
  expectOutcome(run({kMerlin, "snapshot", "-o", dir_ / "x.png", "--instance", nobody}), 1,
                {"no merlind shows a wall as"});
  expectOutcome(run({kMerlin, "shm", "dump", "--instance", nobody}), 1, {"no merlind runs as"});
  EXPECT_FALSE(std::filesystem::exists(dir_ / "x.png"));
}

// The message repeats the command, names the unknown word, and says where to find help.
TEST_F(BadInput, ArgumentsThatNoCommandTakes) {
  const std::string scan = kSource + "/config/models/ankylosaurus.ply";
  expectOutcome(run({kMerlin}), 2, {"merlin: needs a command: status, watch, "});
  expectOutcome(run({kMerlin, "mesh"}), 2, {"merlin mesh: needs a command: import, "});
  expectOutcome(run({kMerlin, "shm", "dum"}), 2,
                {"merlin shm: \"dum\" is not a command; did you mean dump?\nmerlin shm --help "});
  expectOutcome(run({kMerlin, "qqqqqq"}), 2,
                {"merlin: \"qqqqqq\" is not a command; commands are status, watch, "});
  expectOutcome(run({kMerlin, "mesh", "info", scan, "--jsn"}), 2,
                {"merlin mesh info: --jsn is not an option; did you mean --json?"});
  expectOutcome(run({kMerlin, "--instance", "x", "status"}), 2,
                {"merlin status: --instance has to come after the command: "
                 "merlin status --instance\n"});
  expectOutcome(run({kMerlin, "blank", "now"}), 2,
                {"merlin blank: \"now\" is one argument too many"});
  expectOutcome(run({kMerlin, "snapshot"}), 2, {"merlin snapshot: -o is required\n"});
  expectOutcome(run({kMerlin, "mesh", "export", scan, "-o", "x", "--error", "-1"}), 2,
                {"merlin mesh export: --error: \"-1\" is not a number of 0 or more"});
  expectOutcome(run({kMerlin, "watch", "--for", "x"}), 2,
                {"--for: \"x\" is not a number of seconds from 0.1 to 10000000"});
  expectOutcome(run({kMerlin, "mesh", "reduce", scan, "-o", "x.mrm", "--memory", "5X"}), 2,
                {"--memory: \"5X\" is not a number of bytes, such as 900M or 16G"});
  expectOutcome(run({kMerlin, "mesh", "reduce", scan, "-o", "x.mrm", "--threads", "x"}), 2,
                {"merlin mesh reduce: --threads = x: that is not a number"});
  expectOutcome(run({kMerlind, "--role", "none"}), 2, {"merlind: --role: "});
}

TEST_F(BadInput, MeshesThatCannotBeCompared) {
  const std::string scan = kSource + "/config/models/ankylosaurus.ply";
  const std::string line = dir_ / "line.obj";
  writeText(line, "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  expectOutcome(run({kMerlin, "mesh", "compare", scan, line}), 2,
                {scan, line, "the second mesh: none of 1 triangles has an area"});
  expectOutcome(run({kMerlin, "mesh", "compare", dir_ / "none.ply", scan}), 2,
                {"none.ply: No such file or directory"});
  expectOutcome(run({kMerlin, "mesh", "compare", scan, dir_ / "none.mrm"}), 2,
                {"none.mrm: No such file or directory"});
  expectOutcome(run({kMerlin, "mesh", "compare", scan}), 2, {"b is required"});
  expectOutcome(run({kMerlin, "mesh", "compare", scan, scan, "--width", "0"}), 2, {"--width"});
  expectOutcome(run({kMerlin, "mesh", "compare", scan, scan, "--samples", "0"}), 2, {"--samples"});
  expectOutcome(run({kMerlin, "mesh", "compare", scan, scan, "--feature", "heat"}), 2,
                {"feature heat: the first mesh lacks it, the second lacks it"});
  expectOutcome(run({kMerlin, "mesh", "compare", scan, scan, "--pictures", line + "/pictures"}), 1,
                {"line.obj/pictures: Not a directory"});
}

TEST_F(BadInput, MeshCommands) {
  writeText(dir_ / "empty.ply", "");
  writeText(dir_ / "a.xyz", "");
  expectOutcome(run({kMerlin, "mesh", "info", dir_ / "none.ply"}), 2,
                {"none.ply: No such file or directory"});
  expectOutcome(run({kMerlin, "mesh", "info", dir_ / "empty.ply"}), 2,
                {"empty.ply: line 1: a PLY file starts with"});
  expectOutcome(
      run({kMerlin, "mesh", "info", dir_ / "a.xyz"}), 2,
      {"a.xyz: is not a mesh file that can be read here; supported are .ply, .obj, .off, .om and "
       ".stl. merlin"});
  const std::string scan = kSource + "/config/models/ankylosaurus.ply";
  expectOutcome(run({kMerlin, "mesh", "reduce", scan, "-o", dir_ / "o.mrm", "--weight", "colour"}),
                2, {"--weight colour: is not FEATURE=NUMBER"});
  expectOutcome(run({kMerlin, "mesh", "reduce", scan, "-o", dir_ / "o.mrm", "--weight", "heat=1"}),
                2,
                {"weight heat: the mesh has no such feature; it has geometry, normal, curvature, "
                 "boundary, colour"});
  expectOutcome(run({kMerlin, "mesh", "reduce", scan, "-o", "/no/such/folder/o.mrm"}), 2,
                {"/no/such/folder/o.mrm"});
  expectOutcome(run({kMerlin, "mesh", "picture", scan, "-o", dir_ / "o.jpg"}), 2,
                {"o.jpg: the name of a picture must end in .png"});
  expectOutcome(run({kMerlin, "mesh", "info", dir_ / "a\033[31m\xff.ply"}), 2,
                {"/a\\x1b[31m\\xff.ply: No such file or directory"});
  expectOutcome(run({kMerlin, "mesh", "export", scan, "-o", dir_ / "o.dae"}), 2,
                {"o.dae: meshes are written as .ply"});
  expectOutcome(run({kMerlin, "mesh", "export", scan, "-o", dir_ / "o.ply", "--percent", "5",
                     "--triangles", "9"}),
                2, {"triangles"});
}

TEST_F(BadInput, PostureCommands) {
  writeText(dir_ / "hands.csv", "posture,grip\nfist,1\n");
  expectOutcome(run({kMerlin, "posture", "test", "--network", dir_ / "none.json"}), 2,
                {"none.json"});
  expectOutcome(run({kMerlin, "posture", "test", "--network", kSource + "/config/postures.json",
                     "--data", dir_ / "hands.csv"}),
                2, {"hands.csv"});
}

}  // namespace
}  // namespace merlin::test
