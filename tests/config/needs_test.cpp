// Settings that have no effect because another setting is missing are findings.
#include "config/needs.h"

#include <gtest/gtest.h>

#include "config/writer.h"
#include "tests/support/findings.h"

namespace merlin {
namespace {

std::string found(const std::string& json) { return test::findingsOf(loadSettings(json, "")); }

struct Case {
  const char* json;
  const char* finding;
};

class NeedsTest : public testing::TestWithParam<Case> {};

TEST_P(NeedsTest, ASettingThatHasNoEffectAloneIsAFinding) {
  EXPECT_EQ(found(GetParam().json), GetParam().finding);
}

INSTANTIATE_TEST_SUITE_P(
    All, NeedsTest,
    testing::Values(
        Case{R"({"gpio": {"lamp_line": 3}})",
             "f.json:1: /gpio/lamp_line has no effect without /gpio/chip\n"},
        Case{R"({"gpio": {"projector_line": 3}})",
             "f.json:1: /gpio/projector_line has no effect without /gpio/chip\n"},
        Case{R"({"gpio": {"warm_up_s": 3}})",
             "f.json:1: /gpio/warm_up_s has no effect without /gpio/chip\n"},
        Case{R"({"wall": {"playlist": {"dim_to": 0.5}}})",
             "f.json:1: /wall/playlist/dim_to has no effect without /wall/playlist/dim_after_s\n"},
        Case{R"({"wall": {"snapshots_kept": 5}})",
             "f.json:1: /wall/snapshots_kept has no effect without /wall/snapshots\n"},
        Case{R"({"serve": {"samples_keys": "k"}})",
             "f.json:1: /serve/samples_keys has no effect without /serve/samples_endpoint\n"},
        Case{R"({"serve": {"commands_readers": "k"}})",
             "f.json:1: /serve/commands_readers has no effect without /serve/wall_endpoint or "
             "/serve/devices_endpoint or /serve/wall_topics_endpoint\n"},
        Case{R"({"wall": {"input": {"keys": "k"}}})",
             "f.json:1: /wall/input/keys has no effect without /wall/input/endpoint\n"},
        Case{R"({"wall": {"render": {"show_range": [0, 1]}}})",
             "f.json:1: /wall/render/show_range has no effect without /wall/render/show\n"},
        Case{R"({"wall": {"stereo": {"head": {"scale": 2}}}})",
             "f.json:1: /wall/stereo/head/scale has no effect without /wall/stereo/head/station\n"},
        Case{R"({"wall": {"outputs": [{"kind": "shared_memory", "interval_s": 5}]}})",
             "f.json:1: /wall/outputs/0/interval_s has no effect for an output that is not of kind "
             "png\n"},
        Case{
            R"({"wall": {"outputs": [{"correction": {"mesh": {"interpolation": "bilinear"}}}]}})",
            "f.json:1: /wall/outputs/0/correction/mesh/interpolation has no effect without a mesh: "
            "/wall/outputs/0/correction/mesh has no points\n"},
        Case{R"({"wall": {"contents": [{"model": "a.mrm", "show_as": "panorama"}]}})",
             "f.json:1: /wall/contents/0/show_as has no effect for a model: it is for picture and "
             "slides\n"},
        Case{R"({"devices": [{"driver": "cyberglove", "port": "tcp://lab:4001", "baud": 9600}]})",
             "f.json:1: /devices/0/baud has no effect at the port \"tcp://lab:4001\": only serial: "
             "and pty: ports have a speed\n"},
        Case{
            R"({"devices": [{"driver": "evdev", "port": "evdev:/dev/input/event3", "baud": 9600}]})",
            "f.json:1: /devices/0/baud has no effect at the port \"evdev:/dev/input/event3\": only "
            "serial: and pty: ports have a speed\n"}));

TEST(Needs, WhatIsNeededIsThere) {
  for (const char* json :
       {R"({"gpio": {"chip": "gpiochip0", "lamp_line": 3}})",
        R"({"serve": {"wall_topics_endpoint": "tcp://*:7484", "commands_keys": "k",
                      "commands_readers": "r"}})",
        R"({"wall": {"render": {"show": "thermal", "show_range": [0, 1]}}})",
        R"({"wall": {"stereo": {"head": {"station": 2, "scale": 2}}}})",
        R"({"wall": {"outputs": [{"kind": "png", "path": "a.png", "interval_s": 5}]}})",
        R"({"wall": {"contents": [{"picture": "a.tif", "show_as": "panorama"}]}})",
        R"({"devices": [{"driver": "cyberglove", "port": "serial:/dev/ttyS0", "baud": 115200}]})",
        R"({"devices": [{"driver": "cyberglove", "baud": 115200}]})"})
    EXPECT_EQ(found(json), "") << json;
}

// merlind --print-config writes defaults out, also those that depend on the driver's speed.
TEST(Needs, ADefaultThatIsWrittenOutIsValid) {
  for (const char* json :
       {"{}", R"({"devices": [{"driver": "cyberglove", "port": "tcp://lab:4001"}]})"}) {
    const std::string written = settingsText(loadSettings(json, "").settings);
    EXPECT_NE(written.find("\"baud\""), std::string::npos);
    EXPECT_EQ(found(written), "") << written;
  }
}

}  // namespace
}  // namespace merlin
