// The operator's page without a network: who may request what, and the answers.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "daemon/json/json_tree.h"
#include "daemon/page/documents.h"
#include "daemon/page/frame_history.h"
#include "daemon/page/gate.h"
#include "daemon/page/host_names.h"
#include "daemon/page/metrics_text.h"
#include "daemon/page/page_files.h"
#include "daemon/page/phone_address.h"
#include "daemon/page/qr_code.h"
#include "daemon/page/routes.h"
#include "daemon/page/scale_down.h"
#include "daemon/page/settings.h"
#include "daemon/page/showing.h"
#include "daemon/page/shown_pictures.h"
#include "daemon/page/thumbnail_files.h"
#include "daemon/page/thumbnails.h"
#include "daemon/page/token.h"
#include "daemon/status/documents.h"
#include "render/image/image_file.h"
#include "render/image/jpeg_writer.h"
#include "tests/support/temp_dir.h"

namespace merlin::page {
namespace {

const std::string kToken = "abcdefghijklmnopqrstuvwxyz012345";

RouteSettings settings(bool loopback = true) {
  return {{kToken, {"wall.lab.example"}, loopback}, true, true};
}

Request get(const std::string& path, const std::string& host = "127.0.0.1:7480") {
  return {"GET", path, {}, {{"host", host}}, false, ""};
}

Request post(const std::string& body) {
  Request request = get("/api/command");
  request.method = "POST";
  request.headers["authorization"] = "Bearer " + kToken;
  request.headers["content-type"] = "application/json";
  request.body = body;
  return request;
}

// Returns the status of a request that is answered at once; 200 if the request is passed on.
unsigned statusOf(const Request& request, const RouteSettings& s = settings()) {
  const Route found = route(request, s);
  const Answer* const answer = std::get_if<Answer>(&found);
  return answer ? answer->status : 200;
}

std::string textOf(const Request& request) {
  const Route found = route(request, settings());
  const Answer* const answer = std::get_if<Answer>(&found);
  return answer && answer->body ? *answer->body : "";
}

TEST(PageHosts, OnlyAddressesLocalhostAndConfiguredNamesAreTheOwnOnes) {
  const auto status = [](const std::string& host) { return statusOf(get("/api/status", host)); };
  for (const char* host : {"127.0.0.1", "127.0.0.1:7480", "localhost", "LocalHost:99", "[::1]",
                           "[::1]:7480", "127.9.9.9"})
    EXPECT_EQ(status(host), 200U) << host;
  // Another site may resolve these names to this machine's address.
  for (const char* host : {"evil.example", "evil.example:7480", "127.0.0.1.evil.example",
                           "localhost.evil.example", "wall.lab.example.evil.example"})
    EXPECT_EQ(status(host), 403U) << host;
  for (const char* host :
       {"", ":", ":80", "[::1", "[]", "[evil]", "a b", "127.0.0.1:", "127.0.0.1:x",
        "127.0.0.1:123456", "user@127.0.0.1", "127.0.0.1/", "[::1]x"})
    EXPECT_EQ(status(host), 403U) << host;
  EXPECT_EQ(status(std::string(300, 'a')), 403U);
}

TEST(PageHosts, ReadingIsFreeOnlyUnderANameOfThisMachineAtALoopbackAddress) {
  for (const char* path : {"/api/status", "/api/events", "/api/frames", "/api/commands",
                           "/api/contents", "/picture.jpg", "/thumbnail.jpg", "/metrics"}) {
    EXPECT_EQ(statusOf(get(path)), 200U) << path;
    EXPECT_EQ(statusOf(get(path, "wall.lab.example")), 401U) << path << " through a proxy";
    EXPECT_EQ(statusOf(get(path, "192.168.1.7")), 401U) << path;
    EXPECT_EQ(statusOf(get(path), settings(false)), 401U) << path << " at a network's address";
    Request with = get(path, "wall.lab.example:80");
    with.headers["authorization"] = "Bearer " + kToken;
    EXPECT_EQ(statusOf(with, settings(false)), 200U) << path;
  }
  EXPECT_EQ(statusOf(get("/", "wall.lab.example"), settings(false)), 200U)
      << "the page itself, in which the token is entered";
}

// Unless they are configured otherwise, nginx and Apache send the address of the server behind them
// as the host name.
TEST(PageHosts, WhatAProxyPassesOnNeedsTheTokenUnderALoopbackNameToo) {
  Request request = get("/api/status");
  request.passed_on = true;
  EXPECT_EQ(statusOf(request), 401U);
  request.path = "/metrics";
  EXPECT_EQ(statusOf(request), 401U);
  request.headers["authorization"] = "Bearer " + kToken;
  EXPECT_EQ(statusOf(request), 200U);
  request = get("/");
  request.passed_on = true;
  EXPECT_EQ(statusOf(request), 200U) << "the page itself, in which the token is entered";
}

TEST(PageSites, OtherSitesMayNeitherReadNorCommand) {
  const auto with = [](const std::string& name, const std::string& value) {
    Request request = get("/api/status");
    request.headers[name] = value;
    return statusOf(request);
  };
  EXPECT_EQ(with("origin", "http://127.0.0.1:7480"), 200U);
  EXPECT_EQ(with("origin", "https://127.0.0.1:7480"), 200U);
  for (const char* origin : {"null", "http://127.0.0.1", "http://127.0.0.1:7481",
                             "http://evil.example", "http://127.0.0.1:7480.evil.example",
                             "http://localhost:7480", "ftp://127.0.0.1:7480", "127.0.0.1:7480"})
    EXPECT_EQ(with("origin", origin), 403U) << origin;
  EXPECT_EQ(with("sec-fetch-site", "same-origin"), 200U);
  EXPECT_EQ(with("sec-fetch-site", "none"), 200U);
  EXPECT_EQ(with("sec-fetch-site", "cross-site"), 403U);
  EXPECT_EQ(with("sec-fetch-site", "same-site"), 403U);
  Request command = post(R"({"command":"reset_view"})");
  EXPECT_EQ(statusOf(command), 200U);
  command.headers["origin"] = "http://evil.example";
  EXPECT_EQ(statusOf(command), 403U) << "even with the token";
}

TEST(PageSites, ALinkToThePageMayBeFollowed) {
  Request request = get("/");
  request.headers["sec-fetch-site"] = "cross-site";
  request.headers["sec-fetch-mode"] = "navigate";
  EXPECT_EQ(statusOf(request), 200U);
}

TEST(PageToken, CommandsNeedItOnLoopbackToo) {
  Request request = post(R"({"command":"next_content"})");
  EXPECT_EQ(statusOf(request), 200U);
  request.headers.erase("authorization");
  EXPECT_EQ(statusOf(request), 401U);
  std::set<std::string> wrong = {"",
                                 "Bearer",
                                 "Bearer ",
                                 kToken,
                                 "bearer " + kToken,
                                 "Basic " + kToken,
                                 "Bearer " + kToken + " ",
                                 "Bearer " + kToken + "x"};
  for (std::size_t length = 0; length < kToken.size(); ++length)
    wrong.insert("Bearer " + kToken.substr(0, length));
  for (std::size_t i = 0; i < kToken.size(); ++i) {
    std::string damaged = kToken;
    damaged[i] ^= 1;
    wrong.insert("Bearer " + damaged);
  }
  for (const std::string& header : wrong) {
    request.headers["authorization"] = header;
    EXPECT_EQ(statusOf(request), 401U) << header;
  }
  EXPECT_EQ(textOf(request).find(kToken), std::string::npos);
}

TEST(PageToken, AnEmptySecretIsNeverEqual) {
  EXPECT_FALSE(sameSecret("", ""));
  EXPECT_TRUE(sameSecret("a", "a"));
}

TEST(PageToken, AHeaderThatCountsAndWasSentTwiceIsRefused) {
  Request request = get("/api/status");
  request.repeated = true;
  EXPECT_EQ(statusOf(request), 400U);
}

TEST(PageRoutes, EachPathHasItsMethods) {
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", "", "get"}) {
    Request request = get("/api/status");
    request.method = method;
    EXPECT_EQ(statusOf(request), 405U) << method;
    request.path = "/";
    EXPECT_EQ(statusOf(request), 405U) << method;
  }
  Request head = get("/api/status");
  head.method = "HEAD";
  EXPECT_EQ(statusOf(head), 200U);
  EXPECT_EQ(statusOf(get("/api/command")), 405U);
}

TEST(PageRoutes, WhatIsNotThereIsNotFound) {
  for (const char* path : {"/..", "/../token", "//", "/api", "/api/", "/api/statuses", "/api/statu",
                           "/page.js/", "/www/page.js", "/merlin-page.token", "", "x"})
    EXPECT_EQ(statusOf(get(path)), 404U) << path;
}

TEST(PageRoutes, ThePageAndTheMetricsAreSwitchedOffEachOnItsOwn) {
  RouteSettings without_page = settings(), without_metrics = settings();
  without_page.page = false;
  without_metrics.metrics = false;
  for (const char* path : {"/", "/page.js", "/api/status", "/picture.jpg", "/api/command"})
    EXPECT_EQ(statusOf(get(path), without_page), 404U) << path;
  EXPECT_EQ(statusOf(get("/metrics"), without_page), 200U);
  EXPECT_EQ(statusOf(get("/metrics"), without_metrics), 404U);
  EXPECT_EQ(statusOf(get("/api/status"), without_metrics), 200U);
}

TEST(PageRoutes, APictureHasAViewAndOneOfAFewSizes) {
  Request request = get("/picture.jpg");
  auto found = std::get<PictureRoute>(route(request, settings()));
  EXPECT_EQ(found.view, "wall");
  EXPECT_EQ(found.width, 960);
  request.query = {{"view", "tile left"}, {"width", "1920"}, {"after", "17"}};
  found = std::get<PictureRoute>(route(request, settings()));
  EXPECT_EQ(found.view, "tile left");
  EXPECT_EQ(found.width, 1920);
  EXPECT_EQ(found.after, 17U);
  for (const char* width : {"1", "961", "-1", "1e3", "99999999999999999999999", "960 ", "0x3c0"}) {
    request.query["width"] = width;
    EXPECT_EQ(statusOf(request), 400U) << width;
  }
  request.query = {{"view", "attic"}};
  EXPECT_EQ(statusOf(request), 400U);
  EXPECT_NE(textOf(request).find("allowed are wall, operator, tile NAME"), std::string::npos);
  request.query = {{"view", "tile " + std::string(100, 'x')}};
  EXPECT_EQ(statusOf(request), 400U);
  request.query = {{"view", "tile \x1b[2J"}};
  EXPECT_EQ(statusOf(request), 400U);
}

TEST(PageRoutes, AThumbnailIsNamedByItsPlaceAlone) {
  Request request = get("/thumbnail.jpg");
  request.query = {{"content", "7"}};
  EXPECT_EQ(std::get<ThumbnailRoute>(route(request, settings())).content, 7U);
  for (const char* content : {"-1", "x", "7x", "1e3", " 7", "../model.mrm", "/etc/passwd",
                              "99999999999999999999999", "\xff"}) {
    request.query["content"] = content;
    EXPECT_EQ(statusOf(request), 400U) << content;
  }
  request.query["content"] = "7";
  EXPECT_EQ(statusOf(request, settings(false)), 401U);
  request.method = "POST";
  EXPECT_EQ(statusOf(request), 405U);
}

TEST(PageRoutes, ThePhonesCodeNeedsTheToken) {
  Request request = post("{}");
  request.path = "/api/phone";
  request.headers["origin"] = "http://127.0.0.1:7480";
  EXPECT_EQ(std::get<PhoneRoute>(route(request, settings())).origin, "http://127.0.0.1:7480");
  request.headers["origin"] = "http://evil.example";
  EXPECT_EQ(statusOf(request), 403U);
  request.headers.erase("origin");
  request.headers["authorization"] = "Bearer " + std::string(32, 'A');
  EXPECT_EQ(statusOf(request), 401U);
  request.headers.erase("authorization");
  EXPECT_EQ(statusOf(request), 401U) << "on loopback too";
  request.method = "GET";
  EXPECT_EQ(statusOf(request), 405U);
}

TEST(PageCommands, EveryCommandOfTheListThatHasAButtonCanBeSent) {
  int buttons = 0;
  for (const CommandInfo& command : kCommands) {
    const bool expected = command.by_name || command.bindable == Bindable::kOnce;
    if (!expected) continue;
    ++buttons;
    EXPECT_TRUE(isPageCommand(command)) << command.name;
    const std::string body = R"({"command":")" + std::string(command.name) + "\"}";
    if (command.argument.empty()) {
      EXPECT_EQ(statusOf(post(body)), 200U) << command.name;
    }
    EXPECT_NE(commandList().find("\"name\":\"" + std::string(command.name) + "\""),
              std::string::npos);
  }
  EXPECT_GE(buttons, 20);
  for (const char* held :
       {"grab", "fly", "point_at", "align_push", "zoom_in", "status", "flight", "signal"})
    EXPECT_EQ(statusOf(post(R"({"command":")" + std::string(held) + "\"}")), 400U) << held;
}

TEST(PageCommands, AnArgumentIsThereExactlyWhereItIsNeeded) {
  const auto found = route(post(R"({"command":"rate","argument":"25"})"), settings());
  EXPECT_EQ(std::get<CommandRoute>(found).command->name, "rate");
  EXPECT_EQ(std::get<CommandRoute>(found).argument, "25");
  EXPECT_EQ(statusOf(post(R"({"command":"operator_pointer","argument":"10 20 1"})")), 200U);
  EXPECT_EQ(statusOf(post(R"({"command":"rate"})")), 400U);
  EXPECT_NE(textOf(post(R"({"command":"rate"})")).find("needs an argument: HZ|auto"),
            std::string::npos);
  EXPECT_EQ(statusOf(post(R"({"command":"reset_view","argument":"x"})")), 400U);
  EXPECT_EQ(statusOf(post(R"({"command":"rate","argument":25})")), 400U);
  EXPECT_EQ(statusOf(post(R"({"command":"rate","argument":"\u0007"})")), 400U);
}

TEST(PageCommands, NoPrefixAndNoDamagedByteOfARequestIsTakenForAnother) {
  const std::string good = R"({"command":"rate","argument":"25"})";
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_EQ(statusOf(post(good.substr(0, length))), 400U) << length;
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (const char byte : {'\0', '\x80', '"', '}', ' '}) {
      std::string damaged = good;
      damaged[i] = byte;
      const Route found = route(post(damaged), settings());
      const auto* const command = std::get_if<CommandRoute>(&found);
      if (command) {
        EXPECT_EQ(command->command->name, "rate") << damaged;
      }
    }
  }
  EXPECT_EQ(statusOf(post("[]")), 400U);
  EXPECT_EQ(statusOf(post(R"({"command":"next_mode","more":1})")), 400U);
  EXPECT_EQ(statusOf(post(std::string(4000, '['))), 400U);
  Request form = post("command=next_mode");
  form.headers["content-type"] = "application/x-www-form-urlencoded";
  EXPECT_EQ(statusOf(form), 415U) << "a form of another site could send that";
}

TEST(PageFiles, AreAllReachableAndKeptByBrowsersUntilTheyChange) {
  std::set<std::string_view> tags;
  for (const PageFile& file : pageFiles()) {
    EXPECT_EQ(statusOf(get(std::string(file.path))), 200U) << file.path;
    EXPECT_FALSE(file.type.empty()) << file.path;
    EXPECT_TRUE(tags.insert(file.etag).second) << file.path;
    Request again = get(std::string(file.path));
    again.headers["if-none-match"] = file.etag;
    EXPECT_EQ(statusOf(again), 304U) << file.path;
    EXPECT_EQ(file.content,
              test::readText(MERLIN_SOURCE_DIR "/daemon/page/www" + std::string(file.path)));
  }
  EXPECT_EQ(findPageFile("/")->path, "/index.html");
}

// The page's Content-Security-Policy forbids inline content and content from other servers; a
// browser would drop it silently.
TEST(PageFiles, HaveNoInlineScriptsAndStylesAndNothingFromElsewhere) {
  for (const PageFile& file : pageFiles()) {
    for (const char* wrong :
         {" style=", " onclick=", "<script>", "<style", "https://", "eval(", "innerHTML"})
      EXPECT_EQ(file.content.find(wrong), std::string_view::npos) << file.path << ": " << wrong;
  }
}

TEST(PageSettings_, AWrongAddressOrNameIsAFinding) {
  EXPECT_TRUE(validate(PageSettings{}).empty());
  PageSettings s;
  s.host_names = "wall.lab.example  wall";
  EXPECT_TRUE(validate(s).empty());
  s.host_names = "http://wall";
  ASSERT_EQ(validate(s).size(), 1U);
  EXPECT_EQ(validate(s)[0].pointer, "/host_names");
  s = {};
  s.address = "localhost";
  ASSERT_EQ(validate(s).size(), 1U);
  EXPECT_EQ(validate(s)[0].pointer, "/address");
  EXPECT_TRUE(isLoopback("127.0.0.1"));
  EXPECT_TRUE(isLoopback("127.1.2.3"));
  EXPECT_FALSE(isLoopback("0.0.0.0"));
}

TEST(PageFrames, OfTheWallsTraceAreReadOnceAndForgottenOnARestart) {
  const auto trace = std::make_unique<shm::Channel<shm::FrameTrace>>();
  const auto publish = [&](std::int64_t work_ns, std::uint32_t moving, std::uint32_t late) {
    shm::FrameTrace frame{};
    frame.begin_ns = 1000;
    frame.end_ns = 1000 + work_ns;
    frame.moving = moving;
    frame.late = late;
    frame.cost = 7;
    trace->publish(frame);
  };
  FrameHistory history;
  publish(12'000'000, 1, 0);
  publish(40'500'000, 1, 1);
  history.follow(*trace, 1);
  history.follow(*trace, 1);
  EXPECT_EQ(history.since(0), "{\"next\":3,\"frames\":[[1,12.00,7,1],[2,40.50,7,3]]}\n");
  EXPECT_EQ(history.since(1), "{\"next\":3,\"frames\":[[2,40.50,7,3]]}\n");
  for (int i = 0; i < 1000; ++i) publish(1'000'000, 0, 0);
  history.follow(*trace, 1);
  const auto rest = parseJson(history.since(2));
  EXPECT_EQ(rest->members[1].value.items.size(), shm::kHistory - 1) << "what the ring still has";
  for (int round = 0; round < 50; ++round) {
    for (int i = 0; i < 200; ++i) publish(1'000'000, 1, 0);
    history.follow(*trace, 1);
  }
  EXPECT_EQ(parseJson(history.since(0))->members[1].value.items.size(), 1200U);
  history.follow(*std::make_unique<shm::Channel<shm::FrameTrace>>(), 2);
  EXPECT_EQ(parseJson(history.since(0))->members[1].value.items.size(), 0U);
}

TEST(PageMetrics, AreFamiliesWithHelpTypeAndBaseUnits) {
  const std::string text =
      metricsText({{"wall", true,
                    R"({"role":"wall","frames_total":12,"work_ms":2.5,"work_sixteenths_1_total":3,
            "work_sixteenths_2_total":4,"work_sixteenths_3_total":1,"new-thing":5})"},
                   {"devices", false, R"({"role":"devices","glove_ok":1})"}},
                  {.connections = 2});
  const auto has = [&](const std::string& line) {
    EXPECT_NE(("\n" + text).find("\n" + line + "\n"), std::string::npos) << line << "\n" << text;
  };
  has("# HELP merlin_wall_frames_total Frames drawn and presented.");
  has("# TYPE merlin_wall_frames_total counter");
  has("merlin_wall_frames_total 12");
  has("# TYPE merlin_wall_work_seconds gauge");
  has("merlin_wall_work_seconds 0.0025");
  has("merlin_wall_work_periods_total{le=\"0.0625\"} 3");
  has("merlin_wall_work_periods_total{le=\"0.125\"} 7");
  has("merlin_wall_work_periods_total{le=\"+Inf\"} 8");
  has("merlin_wall_new_thing 5");
  has("merlin_up{role=\"wall\"} 1");
  has("merlin_up{role=\"devices\"} 0");
  has("merlin_page_connections 2");
  EXPECT_EQ(text.find("glove"), std::string::npos) << "of a role that does not run";
}

TEST(PageMetrics, OfTheWallAreAllDescribed) {
  shm::WallStats stats{};
  std::strcpy(stats.cost_unit, "triangles");
  const auto segment = std::make_unique<shm::WallSegment>();
  segment->stats.publish(stats);
  const auto published = parseJson(status::wallMetrics(*segment));
  ASSERT_TRUE(published);
  int metrics = 0;
  for (const JsonNode::Member& member : published->members) {
    if (member.value.kind != JsonNode::Kind::kNumber) continue;
    ++metrics;
    EXPECT_TRUE(isDescribed("wall", member.key)) << member.key;
  }
  EXPECT_GT(metrics, 50);
}

TEST(PageMetrics, OfADeviceHaveItsNameAsALabel) {
  const std::string text = metricsText(
      {{"devices", true, R"({"glove_ok":1,"glove_rate_hz":59.5,"left_ball_bad_bytes_total":2})"}},
      {});
  for (const char* line : {"merlin_device_ok{device=\"glove\"} 1\n",
                           "merlin_device_rate_hertz{device=\"glove\"} 59.5\n",
                           "merlin_device_bad_bytes_total{device=\"left_ball\"} 2\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
}

TEST(PageMetrics, OfAMalformedDocumentAreLeftOut) {
  for (const char* document : {"", "{", "[]", "5", R"({"a":"b"})", R"({"a":[1]})"}) {
    const std::string text = metricsText({{"wall", true, document}}, {});
    EXPECT_EQ(text.find("merlin_wall_"), std::string::npos) << document;
    EXPECT_NE(text.find("merlin_up"), std::string::npos) << document;
  }
}

TEST(PagePictures, AreMadeSmallerByMeans) {
  // 4 x 2 pixels: left half 10, right half 200, with one pixel that differs.
  std::vector<std::uint8_t> pixels;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 4; ++column) {
      const auto value = static_cast<std::uint8_t>(column < 2 ? 10 : 200);
      for (int c = 0; c < 3; ++c) pixels.push_back(value);
      pixels.push_back(0);
    }
  }
  pixels[0] = 50;  // red of the first
  const auto small = scaleDown(pixels, 4, 2, 2);
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 1);
  EXPECT_EQ(small.pixels, (std::vector<std::uint8_t>{20, 10, 10, 255, 200, 200, 200, 255}));
  EXPECT_EQ(scaleDown(pixels, 4, 2, 4).pixels, pixels);
  EXPECT_EQ(scaleDown(pixels, 4, 2, 100).width, 4);
  const std::vector<std::uint8_t> tall(std::size_t{4} * 1000, 7);
  EXPECT_EQ(scaleDown(tall, 1, 1000, 10).height, 40);
}

TEST(PageContents, AreADocumentWithTheNumbersOfTheirPictures) {
  EXPECT_EQ(contentsDocument({}, {}), "{\"contents\":[],\"shown\":[]}\n");
  EXPECT_EQ(contentsDocument({{"a \"skull\"", "model", 0, ""}, {"b", "slides", 17, "gone"}},
                             {{"c \"d\"", 18, 256}, {"e", 19, 257}}),
            R"({"contents":[{"name":"a \"skull\"","kind":"model","thumbnail":null,"fault":""},)"
            R"({"name":"b","kind":"slides","thumbnail":17,"fault":"gone"}],)"
            R"("shown":[{"name":"c \"d\"","thumbnail":18,"place":256},)"
            R"({"name":"e","thumbnail":19,"place":257}]})"
            "\n");
}

TEST(ShownPictures, KeepTheirPlacesAndForgetTheOldest) {
  ShownPictures pictures;
  EXPECT_TRUE(pictures.keep("a", "1", 1));
  EXPECT_FALSE(pictures.keep("a", "1", 2)) << "the same picture";
  EXPECT_EQ(pictures.all()[0].number, 1U);
  for (std::size_t i = 1; i < ShownPictures::kMost; ++i)
    EXPECT_TRUE(pictures.keep("b" + std::to_string(i), "2", i + 1));
  EXPECT_TRUE(pictures.keep("a", "3", 100)) << "another picture of the same content";
  EXPECT_EQ(pictures.all()[0].name, "a");
  EXPECT_EQ(*pictures.all()[0].jpeg, "3");
  EXPECT_TRUE(pictures.keep("new", "4", 101));
  EXPECT_EQ(pictures.all().size(), ShownPictures::kMost);
  EXPECT_EQ(pictures.all()[0].name, "a");
  EXPECT_EQ(pictures.all()[1].name, "new") << "in the place of b1, the oldest";
}

TEST(PageContents, ThumbnailsFitIntoTheirBoxWhateverTheirProportions) {
  const auto sizeOf = [](int width, int height) {
    const std::size_t bytes =
        std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const auto jpeg =
        thumbnailOf({width, height, std::vector<std::uint8_t>(bytes, std::uint8_t{99})});
    EXPECT_TRUE(jpeg) << jpeg.error().what;
    const auto image = render::image::decodeImage(
        {reinterpret_cast<const std::uint8_t*>(jpeg->data()), jpeg->size()});
    EXPECT_TRUE(image) << image.error().what;
    return std::pair(image->width, image->height);
  };
  EXPECT_EQ(sizeOf(1920, 480), std::pair(640, 160));
  EXPECT_EQ(sizeOf(800, 800), std::pair(240, 240));
  EXPECT_EQ(sizeOf(100, 50), std::pair(100, 50)) << "it is not enlarged";
  EXPECT_EQ(sizeOf(4000, 1), std::pair(640, 1));
  EXPECT_LE(sizeOf(1, 4000).second, 240);
  EXPECT_EQ(sizeOf(1, 1), std::pair(1, 1));
}

TEST(PageContents, AModelsPictureIsKeptOnceEachTimeThatItComesUp) {
  constexpr auto kStep = std::chrono::milliseconds(250);
  ShowingWatch watch;
  Timestamp now{};
  // Returns the number of steps until the picture is kept, at most 40.
  const auto stepsUntilKept = [&](const Showing& showing) {
    int steps = 0;
    do now += kStep;
    while (!watch.update(showing, now) && ++steps < 40);
    return steps;
  };
  EXPECT_EQ(stepsUntilKept({"a", false, true}), 3) << "0.7 s after full detail";
  EXPECT_EQ(stepsUntilKept({"a", false, true}), 40) << "not again";
  EXPECT_EQ(stepsUntilKept({"b", false, false}), 16) << "4 s, if it never stands still";
  EXPECT_EQ(stepsUntilKept({"a", false, true}), 3) << "it came up again";
  EXPECT_EQ(stepsUntilKept({"c", true, true}), 40) << "black, or under a test card";
  EXPECT_EQ(stepsUntilKept({"c", false, true}), 3) << "it is uncovered";
  EXPECT_EQ(stepsUntilKept({"", false, true}), 40) << "nothing is shown yet";
}

TEST(PageContents, AThumbnailsFileIsReadOnlyIfItIsOne) {
  const test::TempDir dir;
  const ThumbnailFiles files(dir.path(), "lab-page-"), others(dir.path(), "lab-page-2-");
  const auto jpegOf = [](int width, int height) {
    const std::size_t bytes =
        std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    return *render::image::encodeJpeg(width, height, std::vector<std::uint8_t>(bytes), 80);
  };
  const std::string good = jpegOf(640, 160);
  ASSERT_TRUE(files.write("skull", good));
  ASSERT_TRUE(others.write("skull", good));
  EXPECT_TRUE(files.read("skull") == good);
  EXPECT_FALSE(files.read("bone").has_value());
  for (const std::string& wrong :
       {std::string(), std::string("\xFF\xD8"), good.substr(0, 100), "GIF89a" + good,
        jpegOf(641, 10), jpegOf(10, 241), good + std::string(600'000, ' ')}) {
    ASSERT_TRUE(files.write("skull", wrong));
    EXPECT_FALSE(files.read("skull").has_value()) << wrong.size() << " bytes";
  }
  ASSERT_TRUE(files.write("bone", good));
  test::writeText(dir / "lab-page.token", "kept");
  files.removeOthers({"bone"});
  EXPECT_TRUE(files.read("bone") == good);
  EXPECT_TRUE(others.read("skull") == good) << "another instance's";
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 3);
}

TEST(PagePhone, GoesTheWayThatTheBrowserWent) {
  const auto at = [](const std::string& origin, const PagePlace& place) {
    const auto address = phoneAddress(origin, place);
    return address ? *address : "none: " + address.error().what;
  };
  const PagePlace loopback{"127.0.0.1", 7480, {"10.0.0.5"}};
  EXPECT_EQ(at("https://wall.lab.example", loopback), "https://wall.lab.example/") << "a proxy";
  EXPECT_EQ(at("http://10.0.0.9:7480", loopback), "http://10.0.0.9:7480/");
  for (const char* own : {"http://127.0.0.1:7480", "http://localhost:7480", "http://[::1]:7480", "",
                          "null", "http://"}) {
    EXPECT_NE(at(own, loopback).find("it listens only at 127.0.0.1"), std::string::npos) << own;
    EXPECT_EQ(at(own, {"0.0.0.0", 80, {"10.0.0.5", "10.1.0.5"}}), "http://10.0.0.5:80/") << own;
    EXPECT_EQ(at(own, {"10.1.0.5", 7480, {"10.0.0.5"}}), "http://10.1.0.5:7480/") << own;
    EXPECT_NE(at(own, {"0.0.0.0", 80, {}}).find("is not connected to a network"), std::string::npos)
        << own;
  }
}

// Returns whether the code has its three finder patterns: in three corners, a ring of 7 modules
// around a square of 3.
bool hasFinders(const QrCode& code) {
  for (const auto& [left, top] :
       {std::pair(0, 0), std::pair(code.side - 7, 0), std::pair(0, code.side - 7)}) {
    for (int y = 0; y < 7; ++y) {
      for (int x = 0; x < 7; ++x) {
        const int ring = std::max(std::abs(x - 3), std::abs(y - 3));
        if (code.isDark(left + x, top + y) != (ring != 2)) return false;
      }
    }
  }
  return true;
}

TEST(PagePhone, TheCodeIsTheSmallestThatHoldsTheAddress) {
  const auto small = qrCode("MERLIN");
  ASSERT_TRUE(small);
  EXPECT_EQ(small->side, 21);
  EXPECT_TRUE(hasFinders(*small));
  const auto address = qrCode("http://192.168.100.200:7480/#token=" + kToken);
  ASSERT_TRUE(address);
  EXPECT_EQ(address->side, 37) << "version 5: 84 bytes at level M";
  EXPECT_TRUE(hasFinders(*address));
  EXPECT_EQ(qrCode("http://192.168.100.200:7480/#token=" + kToken)->dark, address->dark);
  EXPECT_FALSE(qrCode(""));
  EXPECT_TRUE(qrCode(std::string(2331, 'x')));
  const auto large = qrCode(std::string(2332, 'x'));
  ASSERT_FALSE(large);
  EXPECT_NE(large.error().what.find("2332 bytes"), std::string::npos) << large.error().what;
}

TEST(PagePhone, TheDocumentHasTheCodeButNotTheTokenAsText) {
  const std::string none = phoneDocument({"", "why \"not\"", {}});
  EXPECT_EQ(none, "{\"address\":null,\"why\":\"why \\\"not\\\"\",\"rows\":[]}\n");
  const std::string two = phoneDocument({"http://10.0.0.5/", "", {2, {1, 0, 0, 1}}});
  EXPECT_EQ(two, "{\"address\":\"http://10.0.0.5/\",\"why\":\"\",\"rows\":[\"10\",\"01\"]}\n");
}

TEST(PageTokenFile, IsMadeOnceForUserAndGroupAndKept) {
  const test::TempDir dir;
  const std::string path = dir / "token";
  std::string token;
  {
    const auto made = TokenFile::open(path);
    ASSERT_TRUE(made) << made.error().what;
    token = made->token();
    EXPECT_EQ(token.size(), 32U);
    struct stat status {};
    ASSERT_EQ(::stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777, 0640U);
    EXPECT_EQ(test::readText(path), token + "\n");
    const auto second = TokenFile::open(path);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, Errc::kBusy);
  }
  EXPECT_EQ(TokenFile::open(path)->token(), token) << "so that browsers stay unlocked";
  EXPECT_NE(TokenFile::open(dir / "other")->token(), token);
}

TEST(PageTokenFile, WhatOthersCouldHaveReadOrWrittenIsReplaced) {
  const test::TempDir dir;
  const std::string path = dir / "token", old(32, 'A');
  for (const unsigned mode : {0644U, 0660U, 0606U, 0750U}) {
    test::writeText(path, old + "\n");
    ASSERT_EQ(::chmod(path.c_str(), mode), 0);
    EXPECT_NE(TokenFile::open(path)->token(), old) << std::oct << mode;
  }
  for (const std::string& text : {std::string(), old, old + "\nx", std::string(31, 'A') + "\n",
                                  std::string(31, 'A') + " \n", std::string(5000, 'A')}) {
    test::writeText(path, text);
    ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
    const auto opened = TokenFile::open(path);
    ASSERT_TRUE(opened);
    EXPECT_EQ(opened->token().size(), 32U);
    EXPECT_NE(opened->token(), old);
  }
  std::filesystem::remove(path);
  test::writeText(dir / "elsewhere", old + "\n");
  ASSERT_EQ(::chmod((dir / "elsewhere").c_str(), 0640), 0);
  std::filesystem::create_symlink(dir / "elsewhere", path);
  EXPECT_NE(TokenFile::open(path)->token(), old) << "a link is not followed";
  EXPECT_EQ(test::readText(dir / "elsewhere"), old + "\n");
  EXPECT_FALSE(TokenFile::open(dir / "none/token"));
}

}  // namespace
}  // namespace merlin::page
