// merlin report makes an archive for a person who is asked for help. The test makes it of a running
// wall and of one that does not run.
#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

using nlohmann::json;

constexpr const char* kPassword = "hunter-twenty-two";
constexpr const char* kToken = "TOKEN0123456789TOKEN0123456789xy";

// Returns the archive's files by name, unpacked by another program. The names begin with the
// archive's folder.
std::map<std::string, std::string> unpack(const TempDir& dir, const std::string& archive) {
  const std::string out = dir / "unpacked.json";
  const std::string script =
      "import json, sys, tarfile\n"
      "t = tarfile.open(sys.argv[1], 'r:gz')\n"
      "json.dump({m.name: t.extractfile(m).read().decode('latin-1') for m in t}, open(sys.argv[2], "
      "'w'))";
  const Outcome read = run({"python3", "-c", script, archive, out});
  EXPECT_EQ(read.status, 0) << read.output;
  const json files = json::parse(readText(out), nullptr, false);
  return files.is_object() ? files.get<std::map<std::string, std::string>>()
                           : std::map<std::string, std::string>{};
}

// Makes a key pair; returns the secret key.
std::string makeKeys(const std::string& path) {
  EXPECT_EQ(run({kMerlin, "keys", "-o", path}).status, 0);
  const std::string text = readText(path);
  const std::size_t at = text.find("secret ") + 7;
  return text.substr(at, 40);
}

void expectNowhere(const std::map<std::string, std::string>& files, const std::string& secret) {
  ASSERT_GE(secret.size(), 8u);
  for (const auto& [name, content] : files) {
    EXPECT_EQ(name.find(secret), std::string::npos);
    EXPECT_EQ(content.find(secret), std::string::npos) << name << " has " << secret;
  }
}

TEST(Report, OfARunningWallHasItsPartsAndNoSecret) {
  const TempDir dir;
  const std::string model = makeModel(dir);
  const std::string key = makeKeys(dir / "wall.keys");
  writeText(dir / "wall.clients", std::string(40, 'k') + "\n");
  writeText(dir / "left.password", std::string(kPassword) + "\n");
  MerlindOptions options;
  options.also = {
      {"serve",
       {{"samples_endpoint", "tcp://127.0.0.1:1"},
        {"samples_keys", "wall.keys"},
        {"samples_clients", "wall.clients"}}},
      {"projectors",
       {{{"name", "left"}, {"address", "127.0.0.1:1"}, {"password_file", "left.password"}}}},
      {"alarms", {{{"run", {"/usr/bin/tell", std::string("--token=") + kToken}}}}},
      // A password in a setting that is not marked as secret.
      {"wall", {{"contents", {{{"model", model}, {"name", kPassword}}}}}}};
  Merlind wall(dir, model, "report", options);
  ASSERT_TRUE(wall.ready()) << wall.process().output();
  writeText(dir / (wall.instance() + "-page.token"), kToken);
  std::filesystem::create_directory(dir / "flight");
  writeText(dir / ("flight/" + wall.instance() + "-old-20260101T000000Z.bytes"),
            std::string("# ") + kToken);

  const Outcome made =
      run({kMerlin, "report", "-o", dir / "wall.tar.gz", "--config", wall.config(), "--json"});
  ASSERT_EQ(made.status, 0) << made.output;
  const json parts = json::parse(made.output, nullptr, false);
  ASSERT_TRUE(parts.is_object()) << made.output;
  EXPECT_EQ(parts["parts"].size(), 9u);
  EXPECT_EQ(parts["bytes"], readText(dir / "wall.tar.gz").size());

  const auto files = unpack(dir, dir / "wall.tar.gz");
  for (const char* name :
       {"README.txt", "configuration/settings.json", "configuration/changes.txt",
        "configuration/findings.txt", "status.json", "versions/versions.txt",
        "versions/libraries-of-merlin.txt", "hardware/hardware.txt", "frame.png", "trace.json"})
    EXPECT_TRUE(files.contains(std::string("wall/") + name)) << name << "\n" << made.output;
  EXPECT_EQ(json::parse(files.at("wall/status.json"))["roles"].size(), 2u);
  EXPECT_EQ(files.at("wall/frame.png").find("PNG\r\n"), 2u)
      << "after one byte, which JSON makes two";
  EXPECT_NE(files.at("wall/trace.json").find("\"ph\":\"X\""), std::string::npos) << "a frame";
  EXPECT_TRUE(files.contains("wall/flight/" + wall.instance() + "-old-20260101T000000Z.bytes"));
  const auto recordings = std::count_if(files.begin(), files.end(), [](const auto& f) {
    return f.first.starts_with("wall/flight/");
  });
  EXPECT_GE(recordings, 1 + 3) << "glove, tracker and ball of now: " << made.output;
  EXPECT_NE(files.at("wall/configuration/changes.txt")
                .find("/projectors/0/password_file: (absent) -> \"(left out)\""),
            std::string::npos);
  for (const std::string& secret :
       {std::string(kPassword), std::string(kToken), key, std::string("left.password")})
    expectNowhere(files, secret);
}

TEST(Report, OfAWallThatDoesNotRunSaysSoAndQuotesNoFile) {
  const TempDir dir;
  writeText(dir / "wall.json", std::string(R"({"instance": "merlin-report-none", "password": ")") +
                                   kPassword +
                                   R"(", "projectors": [{"name": "left", "address": "127.0.0.1:1",
                "password_file": ")" +
                                   kPassword + R"("}, ")" + kPassword + "\"]}");
  const Outcome made = run({kMerlin, "report", "-o", dir / "none.tar.gz", "-c", dir / "wall.json"});
  ASSERT_EQ(made.status, 0) << made.output;
  EXPECT_NE(made.output.find("status: 0 files, 0.0 kB\n  missing: status.json: no merlind runs as "
                             "\"merlin-report-none\""),
            std::string::npos)
      << made.output;
  EXPECT_NE(made.output.find(dir / "none.tar.gz"), std::string::npos);
  const auto files = unpack(dir, dir / "none.tar.gz");
  ASSERT_TRUE(files.contains("none/README.txt"));
  EXPECT_NE(files.at("none/README.txt").find("no merlind runs"), std::string::npos);
  EXPECT_NE(files.at("none/configuration/findings.txt").find("/password is not a known setting"),
            std::string::npos);
  EXPECT_TRUE(files.contains("none/hardware/hardware.txt"));
  expectNowhere(files, kPassword);
}

// merlind runs with the last good settings; a token that occurs only in them is still a secret.
TEST(Report, OfABrokenConfigurationHasTheLastGoodOne) {
  const TempDir dir;
  MerlindOptions options;
  options.role = "devices";
  options.also = {{"alarms", {{{"run", {"/usr/bin/tell", std::string("--token=") + kToken}}}}},
                  {"people", {{"stale_after_s", 0.7}}}};
  options.environment = {{"STATE_DIRECTORY", dir.path()}};
  options.last_good = true;
  Merlind devices(dir, "", "broken", options);
  ASSERT_TRUE(devices.ready()) << devices.process().output();
  const auto kept = [&] {
    for (const auto& entry : std::filesystem::directory_iterator(dir.path()))
      if (entry.path().extension() == ".last-good") return entry.path().filename().string();
    return std::string();
  };
  ASSERT_TRUE(eventually([&] { return !kept().empty(); }));
  std::filesystem::create_directory(dir / "flight");
  writeText(dir / ("flight/" + devices.instance() + "-old.bytes"),
            std::string("# --token=") + kToken);
  writeText(devices.config(), "{");

  Process made({kMerlin, "report", "-o", dir / "wall.tar.gz", "-c", devices.config()},
               {{"STATE_DIRECTORY", dir.path()}});
  ASSERT_EQ(made.wait(), 0) << made.output();
  const std::string missing =
      "missing: settings.json: the configuration is invalid: " + devices.config() + ":1: ";
  EXPECT_NE(made.output().find(missing), std::string::npos) << made.output();
  const auto files = unpack(dir, dir / "wall.tar.gz");
  EXPECT_FALSE(files.contains("wall/configuration/settings.json"));
  const std::string name = "wall/configuration/" + kept() + ".json";
  ASSERT_TRUE(files.contains(name)) << made.output();
  EXPECT_EQ(json::parse(files.at(name))["people"]["stale_after_s"], 0.7);
  EXPECT_TRUE(files.contains("wall/status.json")) << "of the instance that they name";
  EXPECT_NE(files.at("wall/README.txt").find("or, where it is invalid, the last good ones"),
            std::string::npos);
  expectNowhere(files, kToken);
}

TEST(Report, TheJournalIsThatOfTheUnitsWithoutSecrets) {
  const TempDir dir;
  // PATH has this folder first, so it hides the real journalctl
  const std::string journalctl = dir / "journalctl";
  writeText(journalctl, std::string("#!/bin/sh\necho \"$@\"\necho typed ") + kPassword + "\n");
  std::filesystem::permissions(journalctl, std::filesystem::perms::owner_all);
  writeText(dir / "left.password", std::string(kPassword) + "\n");
  writeText(dir / "wall.json",
            R"({"instance": "merlin-report-none", "projectors": [
                {"name": "left", "address": "127.0.0.1:1", "password_file": "left.password"}]})");
  Process made({kMerlin, "report", "-o", dir / "none.tar.gz", "-c", dir / "wall.json"},
               {{"PATH", dir.path() + ":/usr/bin:/bin"}});
  ASSERT_EQ(made.wait(), 0) << made.output();
  const auto files = unpack(dir, dir / "none.tar.gz");
  const std::string& journal = files.at("none/journal.txt");
  for (const char* part :
       {"--unit=merlin-devices.service", "--unit=merlin-wall.service", "--unit=merlin-page.service",
        "--unit=merlin-alarms.service", "--since=-1day", "--lines=20000", "\ntyped (left out)\n"})
    EXPECT_NE(journal.find(part), std::string::npos) << part << " is not in " << journal;
  expectNowhere(files, kPassword);
}

TEST(Report, WritesNothingWhereItCannot) {
  const TempDir dir;
  const Outcome named = run({kMerlin, "report", "-o", dir / "wall.zip"});
  EXPECT_EQ(named.status, 2);
  EXPECT_NE(named.output.find("the name of a report must end in .tar.gz"), std::string::npos);
  const Outcome nowhere = run({kMerlin, "report", "-o", dir / "no/wall.tar.gz"});
  EXPECT_EQ(nowhere.status, 2) << nowhere.output;
  EXPECT_EQ(nowhere.output.find("configuration:"), std::string::npos) << "before the long work";
  EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
}

}  // namespace
}  // namespace merlin::test
