// The text of merlin status and the lines of merlin watch, made from the documents of both roles.
#include "daemon/cli/wall/status_text.h"

#include <gtest/gtest.h>

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

const char* const kFull = "state.json: No space left on device";

// Returns a status document of a role whose service "state" has failed for this reason; if the
// reason is empty, the service works.
std::string document(const std::string& role, const std::string& reason) {
  const Json service = {{"health", reason.empty() ? "ok" : "failed"}, {"reason", reason}};
  Json status = {{"role", role}, {"pid", 7}, {"services", {{"state", service}}}};
  if (role == "devices") status["devices"] = {{"glove", {{"health", "ok"}}}};
  return status.dump();
}

TEST(StatusText, AServiceThatHasFailedHasALineWithItsReason) {
  for (const char* role : {"devices", "wall"}) {
    Json both = Json::object();
    mergeStatus(both, document(role, kFull));
    EXPECT_NE(
        statusTable(both).find("service  state          failed   state.json: No space left on "
                               "device\n"),
        std::string::npos)
        << statusTable(both);
    EXPECT_TRUE(statusLine(both).ends_with("  state failed: state.json: No space left on device"))
        << statusLine(both);
    mergeStatus(both, document(role, ""));
    EXPECT_EQ(statusTable(both).find("service"), std::string::npos);
    EXPECT_EQ(statusLine(both).find("state"), std::string::npos);
  }
}

TEST(StatusText, BeforeItsFirstFrameTheWallSaysSo) {
  Json wall = {{"rate_asked", 30}, {"frames", 0}};
  EXPECT_TRUE(statusTable(wall).starts_with("wall     has not shown its first frame yet\n"))
      << statusTable(wall);
  wall["frames"] = 1;
  EXPECT_TRUE(statusTable(wall).starts_with("wall     0.0 of 30 Hz")) << statusTable(wall);
}

TEST(StatusText, NamesTheContentAndWhatComesByItself) {
  Json wall = {{"rate_asked", 30},
               {"frames", 1},
               {"content", {{"name", "harbour"}, {"kind", "slides"}, {"slide", "dawn"}}},
               {"playlist", "waiting"},
               {"playlist_in_s", 41.6}};
  const auto line = [&] {
    const std::string table = statusTable(wall);
    const std::size_t begin = table.find("content  ");
    return begin == std::string::npos ? table
                                      : table.substr(begin, table.find('\n', begin) - begin);
  };
  EXPECT_EQ(line(), "content  harbour (slides: dawn); the playlist begins in 42 s");
  wall["playlist_in_s"] = nullptr;
  EXPECT_EQ(line(), "content  harbour (slides: dawn); the playlist waits");
  wall["playlist"] = "running";
  wall["next_in_s"] = 7.0;
  EXPECT_EQ(line(), "content  harbour (slides: dawn); the playlist runs, the next one in 7 s");
  wall["content"] = {{"name", "skull"}, {"kind", "model"}, {"slide", ""}};
  wall["playlist"] = "off";
  wall["testcard"] = true;
  EXPECT_EQ(line(), "content  skull (model); the playlist is off; a test card covers it");
}

TEST(StatusText, SaysHowCorrectedSignalsComeToTheDisplaysAndWhyTheyAreCopied) {
  Json wall = {{"rate_asked", 30}, {"frames", 1}, {"renderer", {{"correction", "gpu"}}}};
  const auto said = [&] {
    const std::string table = statusTable(wall);
    const std::size_t begin = table.find("corrections ");
    return begin == std::string::npos ? table
                                      : table.substr(begin, table.find('\n', begin) - begin);
  };
  EXPECT_EQ(said(), "corrections by a shader");
  wall["renderer"]["scan_out"] = "drawn";
  EXPECT_EQ(said(), "corrections by a shader, into the displays' memory");
  wall["renderer"]["scan_out_fault"] = "another GPU's";
  EXPECT_EQ(said(),
            "corrections by a shader, into the displays' memory; copied to a display: another "
            "GPU's");
  wall["renderer"]["scan_out"] = "copied";
  EXPECT_EQ(said(), "corrections by a shader; copied to a display: another GPU's");
}

TEST(StatusText, AFailedServiceIsNotHiddenByTheOtherRolesOfTheSameName) {
  for (const char* failed : {"devices", "wall"}) {
    Json both = Json::object();
    for (const char* role : {"devices", "wall"})
      mergeStatus(both, document(role, role == std::string(failed) ? kFull : ""));
    EXPECT_EQ(both["services"]["state"]["reason"], kFull) << failed;
    EXPECT_EQ(both["roles"].size(), 2U);
    mergeStatus(both, document(failed, ""));
    EXPECT_EQ(both["services"]["state"]["health"], "ok") << "it works again";
  }
}

TEST(StatusText, ARoleThatWasRestartedLeavesNoServiceBehind) {
  Json both = Json::object();
  mergeStatus(both, document("wall", kFull));
  mergeStatus(both, R"({"role": "wall", "pid": 8})");
  EXPECT_FALSE(both.contains("services"));
  EXPECT_EQ(statusLine(both), "");
}

}  // namespace
}  // namespace merlin::cli
