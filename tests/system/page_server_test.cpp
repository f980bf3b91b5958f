// `merlind --role page` beside a real merlind: what it shows and sends, and how little hostile
// clients achieve.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/base/sanitizer.h"
#include "render/image/image_file.h"
#include "tests/support/http_flood.h"
#include "tests/support/page_process.h"
#include "tests/support/pyramids.h"

namespace merlin::test {
namespace {

using Json = nlohmann::json;

class PageTest : public testing::Test {
 protected:
  void start(const std::string& script = "visit", const Json& page = Json::object()) {
    Json settings = {{"port", port_}};
    settings.merge_patch(page);
    MerlindOptions options{.script = script};
    options.also = {{"page", settings}};
    wall_ = std::make_unique<Merlind>(dir_, makeModel(dir_, 5), "page", options);
    ASSERT_TRUE(wall_->ready()) << wall_->process().output();
    startPage();
  }
  void startPage() {
    page_ = std::make_unique<PageProcess>(dir_, wall_->config(), wall_->instance(), port_);
    ASSERT_TRUE(page_->ready()) << page_->process().output();
  }
  std::string events() const { return page_->get("/api/events").body; }
  // Requests a picture until there is one. The status 204 means that there was none within a
  // second: the thread that makes pictures has a lower priority than everything else on the
  // machine.
  HttpAnswer picture(const std::string& path) const {
    HttpAnswer answer;
    eventually([&] { return (answer = page_->get(path)).status != 204; });
    return answer;
  }
  bool tells(const std::string& text) const {
    return eventually([&] { return events().find(text) != std::string::npos; });
  }

  TempDir dir_;
  int port_ = freePagePort();
  std::unique_ptr<Merlind> wall_;
  std::unique_ptr<PageProcess> page_;
};

TEST_F(PageTest, ShowsBothRolesTheirEventsTheFramesAndThePicture) {
  start();
  ASSERT_TRUE(eventually([&] { return page_->runs("wall") && page_->runs("devices"); }));
  Json status;
  // On a busy machine, the emulated ball may be silent for so long that it is stale for a moment.
  EXPECT_TRUE(eventually([&] {
    status = page_->json("/api/status");
    return status["roles"]["devices"]["status"]["devices"]["ball"]["health"] == "ok";
  })) << status;
  EXPECT_EQ(status["page"]["instance"], wall_->instance());
  EXPECT_EQ(status["roles"]["wall"]["status"]["rate_asked"], 10);
  EXPECT_TRUE(tells("the role wall runs"));
  ASSERT_TRUE(eventually([&] { return page_->json("/api/frames")["frames"].size() > 20; }));
  const Json frames = page_->json("/api/frames");
  const std::uint64_t last = frames["frames"].back()[0];
  EXPECT_EQ(frames["next"], last + 1);
  const Json later = page_->json(fmt::format("/api/frames?since={}", last));
  for (const Json& frame : later["frames"]) EXPECT_GT(frame[0], last);

  const HttpAnswer wall = picture("/picture.jpg?width=640");
  ASSERT_EQ(wall.status, 200) << wall.head;
  const std::vector<std::uint8_t> bytes(wall.body.begin(), wall.body.end());
  const auto image = render::image::decodeImage(bytes);
  ASSERT_TRUE(image) << image.error().what;
  EXPECT_EQ(image->width, 640);
  EXPECT_EQ(image->height, 160) << "three tiles of 640 x 480 side by side";
  EXPECT_EQ(picture("/picture.jpg?view=tile%20left").status, 200);
  const HttpAnswer index = page_->get("/");
  EXPECT_EQ(index.status, 200);
  EXPECT_NE(index.head.find("Content-Security-Policy: default-src 'none'"), std::string::npos);
  EXPECT_NE(index.head.find("X-Content-Type-Options: nosniff"), std::string::npos);
  EXPECT_EQ(index.head.find("Access-Control"), std::string::npos);
  EXPECT_EQ(index.head.find("Set-Cookie"), std::string::npos);
}

TEST_F(PageTest, APictureOfAWallThatStandsIsSentOnce) {
  start("still");
  ASSERT_TRUE(eventually([&] { return wall_->wall().full_detail == 1; }));
  HttpAnswer picture;
  const auto next = [&] {
    const std::string key = "X-Picture-Number: ";
    const std::size_t at = picture.head.find(key);
    const std::string number =
        at == std::string::npos ? "0" : picture.head.substr(at + key.size(), 13);
    return page_->get("/picture.jpg?after=" + number);
  };
  EXPECT_TRUE(eventually([&] {
    const HttpAnswer newer = next();
    if (newer.status == 200) picture = newer;
    return newer.status == 204 && !picture.body.empty();
  }));
}

TEST_F(PageTest, CommandsReachTheirRoleAndOnlyWithTheToken) {
  start("still");
  ASSERT_TRUE(eventually([&] { return page_->runs("wall"); }));
  const std::string body = R"({"command":"next_mode"})";
  for (const std::string& wrong : {std::string(), std::string(32, 'A'), page_->token() + "A"}) {
    const HttpAnswer refused = askPage(port_, postRequest("/api/command", wrong, body));
    EXPECT_EQ(refused.status, 401) << refused.body;
  }
  EXPECT_STREQ(wall_->wall().mode, "object");
  const HttpAnswer done = page_->send("next_mode");
  EXPECT_EQ(done.status, 200) << done.body;
  EXPECT_EQ(Json::parse(done.body)["ok"], true);
  EXPECT_TRUE(eventually([&] { return std::string(wall_->wall().mode) == "fly"; }));
  EXPECT_EQ(page_->send("rate", "12").status, 200);
  EXPECT_TRUE(eventually([&] { return wall_->wall().rate_asked_hz == 12; }));

  const HttpAnswer refused = page_->send("rate", "1000");
  EXPECT_EQ(refused.status, 400);
  EXPECT_NE(refused.body.find("1 to 240"), std::string::npos) << refused.body;
  const HttpAnswer panel = page_->send("lamp_on");  // this wall has no control panel
  EXPECT_EQ(panel.status, 400) << panel.body;
  EXPECT_EQ(page_->send("align", "list").status, 200);
  EXPECT_TRUE(tells("refused; the last: POST /api/command: status"));
  EXPECT_EQ(page_->process().output().find(page_->token()), std::string::npos);
  EXPECT_EQ(events().find(page_->token()), std::string::npos);
}

TEST_F(PageTest, AModelsThumbnailIsWhatTheWallShowedOfIt) {
  start("still");
  const Json before = page_->json("/api/contents")["contents"];
  ASSERT_EQ(before.size(), 1U);
  EXPECT_EQ(before[0]["name"], "model");
  EXPECT_EQ(before[0]["kind"], "model");
  ASSERT_TRUE(eventually(
      [&] { return page_->json("/api/contents")["contents"][0]["thumbnail"].is_number(); }));
  const HttpAnswer answer = page_->get("/thumbnail.jpg?content=0");
  ASSERT_EQ(answer.status, 200) << answer.head;
  const std::vector<std::uint8_t> bytes(answer.body.begin(), answer.body.end());
  const auto image = render::image::decodeImage(bytes);
  ASSERT_TRUE(image) << image.error().what;
  EXPECT_EQ(image->width, 640);
  EXPECT_EQ(image->height, 160) << "three tiles side by side";
  const auto [darkest, brightest] = std::ranges::minmax(image->pixels);
  EXPECT_GT(brightest - darkest, 50) << "the model is seen";
  wall_->process().kill(SIGTERM);
  page_->process().kill(SIGTERM);
  startPage();
  ASSERT_TRUE(eventually([&] { return page_->get("/thumbnail.jpg?content=0").status == 200; }));
  EXPECT_EQ(page_->get("/thumbnail.jpg?content=0").body, answer.body)
      << "it is kept over a restart of the page, without a wall";
}

TEST_F(PageTest, SaysWhatThePlaylistDoesAndWhatCoversThePicture) {
  start("still");
  const auto wall = [&] { return page_->json("/api/status")["roles"]["wall"]["status"]; };
  ASSERT_TRUE(eventually([&] { return page_->runs("wall"); }));
  EXPECT_EQ(page_->send("playlist", "on").status, 200);
  EXPECT_TRUE(eventually([&] { return wall()["playlist"] == "running"; }));
  EXPECT_GT(wall()["next_in_s"], 0);
  EXPECT_EQ(page_->send("playlist", "off").status, 200);
  EXPECT_TRUE(eventually([&] { return wall()["playlist"] == "off"; }));
  EXPECT_TRUE(eventually([&] { return wall()["next_in_s"].is_null(); }));
  EXPECT_EQ(page_->send("blank").status, 200);
  EXPECT_TRUE(eventually([&] { return wall()["shown"] == "blank"; }));
  EXPECT_EQ(page_->send("align", "list").status, 200) << "as an open page does every two seconds";
  const std::int64_t asked_ns = wall_->wall().updated_ns;
  EXPECT_TRUE(eventually([&] { return wall_->wall().updated_ns > asked_ns + 500'000'000; }));
  EXPECT_EQ(wall_->status()["shown"], "blank") << "reading is no touch";
  // On a busy machine, showing the test card may take longer than the page waits.
  EXPECT_TRUE(eventually([&] { return page_->send("testcard", "grid").status == 200; }));
  EXPECT_TRUE(eventually([&] { return wall()["testcard"] == true; }));
  EXPECT_EQ(page_->send("playlist", "sometimes").status, 400);
}

TEST_F(PageTest, OutlivesTheWallAndShowsThatItIsDown) {
  start("still");
  ASSERT_TRUE(eventually([&] { return page_->runs("wall"); }));
  const std::string token = page_->token();
  wall_->process().kill(SIGKILL);
  ASSERT_TRUE(tells("the role wall does not run"));
  EXPECT_FALSE(page_->runs("wall"));
  EXPECT_EQ(picture("/picture.jpg").status, 200) << "a card";
  const HttpAnswer sent = page_->send("reset_view");
  EXPECT_EQ(sent.status, 503) << sent.body;
  EXPECT_NE(sent.body.find("the role wall does not run"), std::string::npos) << sent.body;
  EXPECT_NE(page_->get("/metrics").body.find("merlin_up{role=\"wall\"} 0"), std::string::npos);
  Process again({kMerlind, "--config", wall_->config(), "--emulate"});
  ASSERT_TRUE(again.saysEventually("ready")) << again.output();
  EXPECT_TRUE(eventually([&] { return page_->runs("wall"); }));
  EXPECT_EQ(page_->send("reset_view").status, 200);
  EXPECT_EQ(page_->process().kill(SIGTERM), 0) << page_->process().output();
  startPage();
  EXPECT_EQ(page_->token(), token) << "browsers stay unlocked";
}

TEST_F(PageTest, MetricsOfBothRolesAreLinesThatPrometheusReads) {
  start();
  ASSERT_TRUE(eventually([&] {
    const std::string text = page_->get("/metrics").body;
    return text.find("merlin_device_ok") != std::string::npos &&
           text.find("merlin_wall_frames_total") != std::string::npos;
  }));
  const HttpAnswer answer = page_->get("/metrics");
  EXPECT_NE(answer.head.find("Content-Type: text/plain; version=0.0.4"), std::string::npos);
  const std::regex help("# HELP ([a-z_][a-z0-9_]*) .+"),
      type("# TYPE ([a-z_][a-z0-9_]*) (counter|gauge)"),
      sample(R"re(([a-z_][a-z0-9_]*)(\{[a-z]+="[^"\\]*"\})? -?[0-9.e+-]+)re");
  std::istringstream lines(answer.body);
  std::string family;
  std::smatch m;
  int samples = 0;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, m, help)) {
      family = m[1];
    } else if (std::regex_match(line, m, type)) {
      EXPECT_EQ(m[1], family) << line;
    } else {
      ASSERT_TRUE(std::regex_match(line, m, sample)) << line;
      EXPECT_EQ(m[1], family) << line;
      ++samples;
    }
  }
  EXPECT_GT(samples, 70);
}

TEST_F(PageTest, StaysWithMetricsAloneAndWaitsWithNothingToServe) {
  start("still", {{"enabled", false}});
  EXPECT_EQ(page_->get("/").status, 404);
  EXPECT_EQ(page_->get("/api/status").status, 404);
  EXPECT_EQ(page_->send("reset_view").status, 404);
  EXPECT_EQ(page_->get("/metrics").status, 200);
  Json config = Json::parse(readText(wall_->config()));
  config["page"]["metrics"] = false;
  writeText(dir_ / "none.json", config.dump());
  const Outcome checked = run({kMerlind, "--check-config", dir_ / "none.json", "--role", "page"});
  EXPECT_EQ(checked.status, 1);
  EXPECT_NE(checked.output.find("/page/enabled is false, and so is /page/metrics"),
            std::string::npos)
      << checked.output;
  EXPECT_EQ(run({kMerlind, "--check-config", dir_ / "none.json", "--role", "wall"}).status, 0);
}

// The page process without a wall, with its own configuration.
class PageAlone : public testing::Test {
 protected:
  std::string config(const std::string& name, const Json& page) {
    Json settings = {{"instance", instance_}, {"run_directory", dir_.path()}, {"page", page}};
    settings["page"]["port"] = port_;
    writeText(dir_ / name, settings.dump());
    return dir_ / name;
  }
  TempDir dir_;
  int port_ = freePagePort();
  std::string instance_ = privateName("page");
};

// While the page is switched off, the process serves nothing, even with --last-good, until a reload
// switches the page on.
TEST_F(PageAlone, SwitchedOffItWaitsForAConfigurationWithAPage) {
  Process page({kMerlind, "--last-good", "--config",
                config("page.json", {{"enabled", false}, {"metrics", false}}), "--role", "page"});
  ASSERT_TRUE(page.saysEventually("the page is switched off")) << page.output();
  config("page.json", {{"enabled", true}});
  ::kill(page.pid(), SIGHUP);
  EXPECT_TRUE(page.saysEventually("the page of merlind")) << page.output();
  EXPECT_EQ(page.kill(SIGTERM), 0) << page.output();
}

TEST_F(PageAlone, ABusyPortIsTriedAgainAndASecondPageIsRefused) {
  const std::string file = config("page.json", Json::object());
  auto other = net::listenTcp("127.0.0.1", port_);
  ASSERT_TRUE(other);
  PageProcess page(dir_, file, instance_, port_);
  ASSERT_TRUE(page.ready()) << page.process().output();
  EXPECT_TRUE(page.process().saysEventually(fmt::format("page: failed (/page/port {}", port_)))
      << page.process().output();
  other->reset();
  EXPECT_TRUE(page.process().saysEventually("page: running")) << page.process().output();
  EXPECT_EQ(page.get("/").status, 200);
  EXPECT_NE(page.get("/api/events").body.find("page: failed"), std::string::npos);
  const Outcome second = run({kMerlind, "--config", file, "--role", "page"});
  EXPECT_EQ(second.status, 3) << second.output;
  EXPECT_NE(second.output.find("already serves this page"), std::string::npos) << second.output;
}

TEST_F(PageAlone, AtANetworksAddressReadingNeedsTheTokenToo) {
  PageProcess page(dir_, config("page.json", {{"address", "0.0.0.0"}}), instance_, port_);
  ASSERT_TRUE(page.ready()) << page.process().output();
  EXPECT_EQ(page.get("/").status, 200);
  for (const char* path : {"/api/status", "/picture.jpg", "/metrics", "/api/events"}) {
    EXPECT_EQ(page.get(path).status, 401) << path;
    // 204: there is no picture yet
    const int status = page.get(path, "Authorization: Bearer " + page.token() + "\r\n").status;
    EXPECT_TRUE(status == 200 || status == 204) << path << ": " << status;
  }
}

TEST_F(PageAlone, WhatAProxyPassesOnNeedsTheTokenForReadingToo) {
  PageProcess page(dir_, config("page.json", Json::object()), instance_, port_);
  ASSERT_TRUE(page.ready()) << page.process().output();
  EXPECT_EQ(page.get("/api/status").status, 200);
  for (const char* header : {"X-Forwarded-For: 10.0.0.9", "x-forwarded-host: wall.lab.example",
                             "X-Real-IP: 10.0.0.9", "Forwarded: for=10.0.0.9", "Via: 1.1 proxy",
                             "X-Forwarded-Proto: https", "Via: 1.1 a\r\nVia: 1.1 b"}) {
    const std::string passed_on = std::string(header) + "\r\n";
    EXPECT_EQ(page.get("/api/status", passed_on).status, 401) << header;
    EXPECT_EQ(page.get("/", passed_on).status, 200) << header;
    const std::string token = "Authorization: Bearer " + page.token() + "\r\n";
    EXPECT_EQ(page.get("/api/status", passed_on + token).status, 200) << header;
  }
}

TEST_F(PageAlone, ListsContentsAndReadsTheirPicturesFromTheirFiles) {
  const std::string good = dir_ / "meadow.tif", bad = dir_ / "bad.tif", slides = dir_ / "talk";
  writeText(good, pyramidBytes({.width = 800, .height = 200, .description = "MERLIN panorama"}));
  writeText(bad, "II no pyramid");
  std::filesystem::create_directory(slides);
  writeText(slides + "/2.tif", pyramidBytes());
  writeText(slides + "/1.tif", "cut");  // this file is left out
  const std::string file = config("page.json", Json::object());
  Json settings = Json::parse(readText(file));
  settings["wall"]["contents"] = {{{"picture", good}},
                                  {{"picture", bad}, {"name", "the bad one"}},
                                  {{"slides", slides}},
                                  {{"model", dir_ / "missing.mrm"}}};
  writeText(file, settings.dump());
  PageProcess page(dir_, file, instance_, port_);
  ASSERT_TRUE(page.ready()) << page.process().output();
  const auto contents = [&] { return page.json("/api/contents")["contents"]; };
  ASSERT_TRUE(eventually([&] { return contents()[2]["thumbnail"].is_number(); })) << contents();
  const Json all = contents();
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(all[0]["name"], "meadow");
  EXPECT_EQ(all[0]["kind"], "panorama") << "as the file says";
  EXPECT_TRUE(all[0]["thumbnail"].is_number());
  EXPECT_EQ(all[1]["name"], "the bad one");
  EXPECT_TRUE(all[1]["thumbnail"].is_null());
  EXPECT_NE(all[1]["fault"].get<std::string>().find("bad.tif"), std::string::npos) << all[1];
  EXPECT_EQ(all[2]["kind"], "slides");
  EXPECT_EQ(all[3]["kind"], "model");
  EXPECT_TRUE(all[3]["thumbnail"].is_null()) << "no wall has shown it";
  const auto pictureOf = [&](int content) {
    const HttpAnswer answer = page.get(fmt::format("/thumbnail.jpg?content={}", content));
    EXPECT_EQ(answer.status, 200) << content;
    const std::vector<std::uint8_t> bytes(answer.body.begin(), answer.body.end());
    const auto image = render::image::decodeImage(bytes);
    EXPECT_TRUE(image) << image.error().what;
    return image ? std::pair(image->width, image->height) : std::pair(0, 0);
  };
  EXPECT_EQ(pictureOf(0), std::pair(640, 160));
  EXPECT_EQ(pictureOf(2), std::pair(480, 240));
  for (const char* none : {"1", "3", "4", "18446744073709551615"})
    EXPECT_EQ(page.get(std::string("/thumbnail.jpg?content=") + none).status, 404) << none;
  for (const char* wrong : {"-1", "meadow", "..%2fbad.tif", "18446744073709551616"})
    EXPECT_EQ(page.get(std::string("/thumbnail.jpg?content=") + wrong).status, 400) << wrong;
}

TEST_F(PageAlone, ThePhonesCodeIsForWhoHasTheTokenAndWhereAPhoneCanGo) {
  const auto ask = [&](const std::string& token) {
    return askPage(port_, postRequest("/api/phone", token, "{}"));
  };
  {
    PageProcess page(dir_, config("page.json", Json::object()), instance_, port_);
    ASSERT_TRUE(page.ready()) << page.process().output();
    EXPECT_EQ(ask(std::string(32, 'A')).status, 401);
    const Json here = Json::parse(ask(page.token()).body);
    EXPECT_TRUE(here["address"].is_null());
    EXPECT_TRUE(here["rows"].empty());
    EXPECT_NE(here["why"].get<std::string>().find("listens only at 127.0.0.1"), std::string::npos);
    EXPECT_EQ(page.process().kill(SIGTERM), 0) << page.process().output();
  }
  PageProcess page(dir_, config("page.json", {{"address", "0.0.0.0"}}), instance_, port_);
  ASSERT_TRUE(page.ready()) << page.process().output();
  const HttpAnswer answer = ask(page.token());
  EXPECT_EQ(answer.body.find(page.token()), std::string::npos) << "in the code alone";
  const Json there = Json::parse(answer.body);
  if (there["address"].is_null()) GTEST_SKIP() << there["why"];
  EXPECT_TRUE(there["address"].get<std::string>().ends_with(fmt::format(":{}/", port_)));
  EXPECT_GE(there["rows"].size(), 33U);
  for (const Json& row : there["rows"])
    EXPECT_EQ(row.get<std::string>().size(), there["rows"].size());
}

std::size_t residentKb(pid_t pid) {
  const std::string status = readText(fmt::format("/proc/{}/status", pid));
  const std::size_t at = status.find("VmRSS:");
  return at == std::string::npos ? 0 : std::stoul(status.substr(at + 6));
}

std::size_t threads(pid_t pid) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry :
       std::filesystem::directory_iterator(fmt::format("/proc/{}/task", pid)))
    ++count;
  return count;
}

#if defined(MERLIN_ANY_SANITIZER)
constexpr std::size_t kMostMemory_kb = 1'000'000;
#else
constexpr std::size_t kMostMemory_kb = 100'000;
#endif

// Two clients send requests without a pause, and others misbehave in many ways. A well-behaved
// client is still answered, and the wall goes on.
TEST_F(PageTest, HostileClientsDisturbNobodyElse) {
  start();
  ASSERT_TRUE(eventually([&] { return page_->runs("wall"); }));
  const pid_t pid = page_->process().pid();
  ASSERT_EQ(page_->send("align", "list").status, 200);  // all threads have been started by now
  const std::size_t threads_before = threads(pid);
  HttpFlood flood(port_, 2);
  // Waits until 20 further requests of the flood were refused, since on a busy machine most are
  // answered so late that the flood stays below the limit. Then sends ten requests, and expects
  // that they are answered.
  const auto modest = [&](const char* when) {
    const std::uint64_t refused_before = flood.refused();
    EXPECT_TRUE(eventually([&] { return flood.refused() > refused_before + 20; })) << when;
    KeptConnection client(port_);
    for (int i = 0; i < 10; ++i) EXPECT_EQ(client.get("/api/status"), 200) << when << ": " << i;
  };
  for (int i = 0; i < 3; ++i) modest("two clients flood");
  std::vector<UniqueFd> hostile;
  const auto join = [&](const std::string& bytes) {
    hostile.push_back(connectToPage(port_));
    sendText(hostile.back(), bytes);
  };
  const auto good = [&](const char* after) {
    // All clients have the same address here, so a place for a new client becomes free only after a
    // second.
    EXPECT_TRUE(eventually([&] { return page_->get("/api/status").status == 200; })) << after;
    EXPECT_TRUE(eventually([&] { return page_->send("align", "list").status == 200; })) << after;
    EXPECT_LT(residentKb(pid), kMostMemory_kb) << after;
    EXPECT_EQ(threads(pid), threads_before) << after;
    EXPECT_FALSE(page_->process().ended()) << page_->process().output();
  };
  std::string many;  // more than the system's socket buffers hold
  for (int i = 0; i < 100; ++i)
    many += "GET /picture.jpg?width=1920 HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
  for (int i = 0; i < 100; ++i) join(many);
  good("readers that stall");
  std::string thumbnails;
  for (int i = 0; i < 300; ++i)
    thumbnails +=
        fmt::format("GET /thumbnail.jpg?content={} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n", i);
  for (int i = 0; i < 100; ++i) join(thumbnails);
  good("a flood of thumbnails");
  for (int i = 0; i < 200; ++i) join(i % 2 == 0 ? "" : "GET / HT");
  good("200 half requests");
  for (const std::string& bytes :
       {std::string(100'000, '\xFF'), std::string("\0\0\0\0", 4), std::string("\r\n\r\n\r\n"),
        "GET /" + std::string(100'000, 'a') + " HTTP/1.1\r\n\r\n",
        std::string("GET / HTTP/9.9\r\n\r\n"),
        "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n" + std::string(100'000, 'h') + ": 1\r\n\r\n",
        std::string("GET / HTTP/1.1\r\n\r\n"),
        std::string("POST /api/command HTTP/1.1\r\nHost: 127.0.0.1\r\n"
                    "Content-Length: 99999999999999999999\r\n\r\n"),
        std::string("POST /api/command HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: "
                    "chunked\r\n\r\nFFFFFFFF\r\n"),
        std::string("\x16\x03\x01\x02\x00\x01", 6)})
    join(bytes);
  good("garbage");
  // Sends the request until the server has a free place, and returns the answer's status. Without a
  // free place the answer is 429, or the connection is closed (0).
  const auto statusOf = [&](const std::string& request) {
    int status = 0;
    const auto answered = [&] {
      status = askPage(port_, request).status;
      return status != 0 && status != 429;
    };
    eventually(answered);
    return status;
  };
  const std::string large(1'000'000, ' ');
  EXPECT_EQ(statusOf(postRequest("/api/command", page_->token(), large)), 413);
  const std::string end = "Connection: close\r\n\r\n", get = "GET /api/status HTTP/1.1\r\n";
  EXPECT_EQ(statusOf(get + "Host: evil.example\r\n" + end), 403);
  EXPECT_EQ(statusOf(get + "Host: 127.0.0.1\r\nHost: evil.example\r\n" + end), 400);
  EXPECT_EQ(statusOf(getRequest("/api/status", "Origin: http://evil.example\r\n")), 403);
  for (int i = 0; i < 200; ++i) join("");
  good("200 connections");
  EXPECT_TRUE(tells("connections were refused or closed")) << events();
  hostile.clear();
  good("they left");
  modest("two clients still flood");
  flood.stop();
  EXPECT_TRUE(wall_->status().is_object());
  EXPECT_EQ(page_->process().kill(SIGTERM), 0) << page_->process().output();
}

}  // namespace
}  // namespace merlin::test
