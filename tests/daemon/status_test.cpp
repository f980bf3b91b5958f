#include <array>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>
#include <zmq.hpp>

#include "daemon/base/log.h"
#include "daemon/net/connection_server.h"
#include "daemon/status/client.h"
#include "daemon/status/documents.h"
#include "daemon/status/health_events.h"
#include "daemon/status/role_follower.h"
#include "daemon/status/run_directory.h"
#include "daemon/status/server.h"
#include "daemon/status/watchdog.h"
#include "tests/support/eventually.h"
#include "tests/support/local_devices.h"
#include "tests/support/temp_dir.h"
#include "tests/support/told.h"

namespace merlin::status {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::seconds;

const Timestamp kNow{seconds(1000)};

DeviceHealth healthy(const char* identity) {
  DeviceHealth h{};
  h.state = HealthState::kOk;
  h.since_ns = toNanoseconds(kNow - seconds(10));
  h.updated_ns = toNanoseconds(kNow);
  h.rate_hz = 100;
  h.samples = 1234;
  std::snprintf(h.identity, sizeof h.identity, "%s", identity);
  return h;
}

class DocumentsTest : public testing::Test {
 protected:
  test::LocalDevices devices_;
  std::unique_ptr<shm::WallSegment> wall_ = std::make_unique<shm::WallSegment>();
};

TEST_F(DocumentsTest, DevicesSayHealthReasonAndPosture) {
  devices_->health[test::kGlove].publish(healthy("CyberGlove"));
  DeviceHealth gone{};
  std::snprintf(gone.reason, sizeof gone.reason, "/dev/x: No such file");
  devices_->health[test::kBall].publish(gone);
  PostureSample posture{};
  std::snprintf(posture.name, sizeof posture.name, "fist");
  devices_->glove[0].posture.publish(posture);
  const json s = json::parse(devicesStatus(devices_.slots(), kNow));
  EXPECT_EQ(s["role"], "devices");
  EXPECT_EQ(s["posture"], "fist");
  EXPECT_EQ(s["devices"]["glove"]["health"], "ok");
  EXPECT_EQ(s["devices"]["glove"]["identity"], "CyberGlove");
  EXPECT_EQ(s["devices"]["glove"]["since_s"], 10);
  EXPECT_EQ(s["devices"]["ball"]["health"], "absent");
  EXPECT_EQ(s["devices"]["ball"]["reason"], "/dev/x: No such file");
}

TEST_F(DocumentsTest, AHealthThatNobodyWritesAnyMoreIsStale) {
  const DeviceHealth h = healthy("x");
  EXPECT_STREQ(shm::healthName(h, kNow + milliseconds(900)), "ok");
  EXPECT_STREQ(shm::healthName(h, kNow + milliseconds(1100)), "stale");
}

TEST_F(DocumentsTest, TextThatIsNoUtf8BecomesJsonAllTheSame) {
  devices_->health[test::kGlove].publish(healthy("\xFF\xFE\"\\"));
  EXPECT_TRUE(json::accept(devicesStatus(devices_.slots(), kNow)));
}

TEST_F(DocumentsTest, TheWallSaysWhatOutsideChecksRelyOn) {
  shm::WallStats stats{};
  stats.rate_asked_hz = 30;
  stats.rate_held_hz = 29.5F;
  stats.late_share = 0.015F;
  stats.cost = 12345;
  std::strcpy(stats.cost_unit, "triangles");
  wall_->stats.publish(stats);
  const json s = json::parse(wallStatus(*wall_, kNow));
  EXPECT_EQ(s["rate_asked"], 30);
  EXPECT_EQ(s["rate_held"], 29.5);
  EXPECT_EQ(s["late_percent"], 1.5);
  EXPECT_EQ(s["triangles"], 12345);
  EXPECT_EQ(s["detail"]["cost"], 12345);
}

TEST_F(DocumentsTest, TheWallSaysWhoDrawsIt) {
  EXPECT_FALSE(json::parse(wallStatus(*wall_, kNow)).contains("renderer")) << "not known yet";
  const RendererState gpu{.name = "Some GPU",
                          .vendor = "Somebody",
                          .driver = "4.6",
                          .library = "EGL",
                          .node = "/dev/dri/renderD128",
                          .pci = "0000:01:00.0",
                          .software = false,
                          .read_back = "asynchronous",
                          .correction = "gpu",
                          .scan_out = "drawn"};
  const json s = json::parse(wallStatus(*wall_, kNow, {}, nullptr, &gpu));
  EXPECT_EQ(s["renderer"].dump(),
            R"({"contexts":1,"correction":"gpu","correction_fault":"","driver":"4.6",)"
            R"("library":"EGL","name":"Some GPU","node":"/dev/dri/renderD128",)"
            R"("pci":"0000:01:00.0","read_back":"asynchronous","scan_out":"drawn",)"
            R"("scan_out_fault":"","software":false,)"
            R"("vendor":"Somebody"})");
}

TEST_F(DocumentsTest, TheWallSaysWhereAHandPoints) {
  EXPECT_TRUE(json::parse(wallStatus(*wall_, kNow))["pointer"].is_null());
  wall_->interaction.publish(
      {0, shm::WallInteraction::kAtModel, {960, 240}, {0, 0.25F, 1}, 3, 0, 0, 0, 1});
  const json s = json::parse(wallStatus(*wall_, kNow));
  EXPECT_EQ(s["pointer"].dump(), R"({"at":"model","at_model_m":[0.0,0.25,1.0],"pixel":[960,240]})");
  EXPECT_EQ(s["snapshots"], 3);
  wall_->interaction.publish({0, shm::WallInteraction::kAtWall, {-1, -1}, {}, 3, 0, 0, 0, 1});
  EXPECT_TRUE(json::parse(wallStatus(*wall_, kNow))["pointer"]["pixel"].is_null());
}

TEST_F(DocumentsTest, TheWallSaysWhatAClientHasItSayAndWhereFilesGo) {
  EXPECT_EQ(json::parse(wallStatus(*wall_, kNow))["notice"], "");
  wall_->notice.publish({1, "Reading scan.pgm: 45 %"});
  const std::string status = wallStatus(*wall_, kNow);
  EXPECT_EQ(json::parse(status)["notice"], "Reading scan.pgm: 45 %");
  const json s =
      json::parse(addShownFolder(status, {"/var/lib/merlin/merlin.shown", 4096, "", {"scan"}}));
  EXPECT_EQ(
      s["shown_folder"].dump(),
      R"({"fault":"","limit_bytes":4096,"names":["scan"],"path":"/var/lib/merlin/merlin.shown"})");
  EXPECT_EQ(s["notice"], "Reading scan.pgm: 45 %");
  const std::string missing = addMissingContents(status, {{"dome", "dome.tif: is cut"}});
  EXPECT_EQ(json::parse(missing)["missing_contents"].dump(), R"({"dome":"dome.tif: is cut"})");
  EXPECT_FALSE(json::parse(addMissingContents(status, {})).contains("missing_contents"));
}

TEST_F(DocumentsTest, TheWallSaysWhatItShowsWhileNobodyTouchesIt) {
  shm::WallInteraction interaction{};
  interaction.shown = shm::WallInteraction::kFrozen;
  interaction.playlist = shm::WallInteraction::kPlaylistRunning;
  interaction.light = 0.25F;
  wall_->interaction.publish(interaction);
  const json s = json::parse(wallStatus(*wall_, kNow));
  EXPECT_EQ(s["shown"], "frozen");
  EXPECT_EQ(s["playlist"], "running");
  EXPECT_EQ(s["light"], 0.25);
  EXPECT_TRUE(s["next_in_s"].is_null()) << "nothing is known";
  EXPECT_EQ(s["testcard"], false);
  wall_->idle.publish({0, -1, 41.5F, 0, 1});
  const json idle = json::parse(wallStatus(*wall_, kNow));
  EXPECT_TRUE(idle["playlist_in_s"].is_null());
  EXPECT_EQ(idle["next_in_s"], 41.5);
  EXPECT_EQ(idle["dim_in_s"], 0);
  EXPECT_EQ(idle["testcard"], true);
  interaction.shown = shm::WallInteraction::kBlank;
  interaction.playlist = shm::WallInteraction::kPlaylistWaiting;
  wall_->interaction.publish(interaction);
  EXPECT_EQ(json::parse(wallStatus(*wall_, kNow))["shown"], "blank");
  EXPECT_EQ(json::parse(wallStatus(*wall_, kNow))["playlist"], "waiting");
}

TEST_F(DocumentsTest, TheWallSaysWhatItsOutputsWereFoundToShow) {
  shm::WallOutputs outputs{};
  outputs.count = 4;
  for (std::uint32_t i = 0; i < 4; ++i) {
    outputs.outputs[i].name[0] = static_cast<char>('a' + i);
    outputs.outputs[i].picture = std::array{0U, 1U, 4U, 99U}[i];
  }
  std::snprintf(outputs.outputs[2].picture_fault, sizeof outputs.outputs[2].picture_fault, "torn");
  outputs.outputs[2].picture_ms = 1.5F;
  wall_->outputs.publish(outputs);
  const json s = json::parse(wallStatus(*wall_, kNow))["outputs"];
  EXPECT_EQ(s["a"]["picture"], "unchecked");
  EXPECT_EQ(s["b"]["picture"], "right");
  EXPECT_EQ(s["b"]["picture_reason"], "");
  EXPECT_EQ(s["c"]["picture"], "torn");
  EXPECT_EQ(s["c"]["picture_reason"], "torn");
  EXPECT_EQ(s["c"]["picture_ms"], 1.5);
  EXPECT_EQ(s["d"]["picture"], "unchecked") << "whatever that number means";
  const json metrics = json::parse(wallMetrics(*wall_));
  EXPECT_EQ(metrics["outputs_right"], 1);
  EXPECT_EQ(metrics["outputs_wrong"], 1);
}

TEST_F(DocumentsTest, TheWallSaysHowItKeepsItsRate) {
  shm::WallStats stats{};
  stats.cost_exponent = 0.7F;
  stats.rate_divisor = 2;
  stats.held_cost = 9;
  stats.least_cost = 7;
  stats.settle_frames = 3;
  stats.oscillation = 0.05F;
  stats.work_histogram[31] = 4;
  wall_->stats.publish(stats);
  const json s = json::parse(wallStatus(*wall_, kNow));
  EXPECT_EQ(s["cost_exponent"], 0.7);
  EXPECT_EQ(s["rate_divisor"], 2);
  EXPECT_EQ(s["detail"]["held_cost"], 9);
  EXPECT_EQ(s["detail"]["least_cost"], 7);
  EXPECT_EQ(s["settle_frames"], 3);
  EXPECT_EQ(s["oscillation"], 0.05);
  EXPECT_EQ(s["operator_coarser"], false);
  ASSERT_EQ(s["work_histogram"].size(), 32u);
  EXPECT_EQ(s["work_histogram"][31], 4);
}

TEST_F(DocumentsTest, SamplesAreTheNewestOfEachThatThereIs) {
  EXPECT_EQ(json::parse(newestSamples(devices_.slots(), kNow)).size(), 3u)
      << "now_ns, time_utc, health";
  TrackerSample tracker{};
  tracker.station = 2;
  tracker.position_m[1] = 0.5F;
  devices_->tracker[0].stations[1].publish(tracker);
  BallSample ball{};
  ball.counter = 3;
  devices_->ball[0].publish(ball);
  const json s = json::parse(newestSamples(devices_.slots(), kNow));
  EXPECT_EQ(s["tracker"][0]["station"], 2);
  EXPECT_EQ(s["tracker"][0]["position_m"], json({0, 0.5, 0}));
  EXPECT_EQ(s["ball"]["counter"], 3);
  EXPECT_FALSE(s.contains("glove"));
}

// The names are those of shared memory: "glove" is the glove's own measurement, "hand" combines
// glove and tracker.
TEST_F(DocumentsTest, TheGloveIsCalledGloveAndTheHandHand) {
  GloveSample glove{};
  glove.sensors = 22;
  devices_->glove[0].samples.publish(glove);
  HandSample hand{};
  hand.delay_s = 0.25F;
  devices_->hand[0].publish(hand);
  const json s = json::parse(newestSamples(devices_.slots(), kNow));
  EXPECT_EQ(s["glove"]["sensors"], 22);
  EXPECT_EQ(s["hand"]["delay_s"], 0.25);
  EXPECT_FALSE(s.contains("pose"));
}

TEST_F(DocumentsTest, EachSaysTheTimeOfDayBesideTheMonotonicOne) {
  devices_->header.realtime_offset_ns = 1'795'399'507'000'250'000;
  wall_->header.realtime_offset_ns = 1'795'399'507'000'250'000;
  const char* then = "2026-11-23T02:21:47.000250Z";  // kNow is 1000 s
  EXPECT_EQ(json::parse(newestSamples(devices_.slots(), kNow))["time_utc"], then);
  EXPECT_EQ(json::parse(devicesStatus(devices_.slots(), kNow))["time_utc"], then);
  EXPECT_EQ(json::parse(wallStatus(*wall_, kNow))["time_utc"], then);
  const std::string today =
      json::parse(event("x", newsEvent("y"), SystemClock().now()))["time_utc"];
  EXPECT_EQ(today.size(), 27u);
  EXPECT_GT(today, "2024");
}

TEST_F(DocumentsTest, MetricsAreFlatNumbers) {
  devices_->health[test::kTracker].publish(healthy("x"));
  const json m = json::parse(devicesMetrics(devices_.slots()));
  EXPECT_EQ(m["tracker_ok"], 1);
  EXPECT_EQ(m["tracker_samples_total"], 1234);
  EXPECT_EQ(json::parse(wallMetrics(*wall_))["late_total"], 0);
  shm::WallStats stats{};
  stats.work_histogram[13] = 77;
  wall_->stats.publish(stats);
  const json w = json::parse(wallMetrics(*wall_));
  EXPECT_EQ(w["work_sixteenths_14_total"], 77);
  for (const auto& [name, value] : w.items()) EXPECT_TRUE(value.is_number() || name == "role");
}

TEST_F(DocumentsTest, TheLastGestureOfEachHand) {
  EXPECT_EQ(json::parse(devicesStatus(devices_.slots(), kNow))["gestures"]["hand"], nullptr)
      << "none is recognised";
  HealthEvents events(devices_.slots());
  devices_->gesture[0].publish({});
  const json none = json::parse(devicesStatus(devices_.slots(), kNow))["gestures"]["hand"];
  EXPECT_EQ(none["counter"], 0);
  EXPECT_EQ(none["age_s"], nullptr);
  EXPECT_TRUE(events.takeGestures().empty());
  GestureState push{};
  push.received_ns = toNanoseconds(kNow) - 1'500'000'000;
  push.counter = 3;
  push.passed_over = 1;
  push.certainty = 0.5F;
  std::snprintf(push.name, sizeof push.name, "push");
  devices_->gesture[0].publish(push);
  EXPECT_EQ(json::parse(devicesStatus(devices_.slots(), kNow))["gestures"]["hand"],
            json({{"name", "push"},
                  {"counter", 3},
                  {"age_s", 1.5},
                  {"certainty", 0.5},
                  {"passed_over", 1}}));
  EXPECT_EQ(test::told(events.takeGestures()), test::Sentences{"hand: gesture push"});
  EXPECT_TRUE(events.takeGestures().empty());
  push.passed_over = 2;
  devices_->gesture[0].publish(push);
  EXPECT_TRUE(events.takeGestures().empty()) << "what is none is no event";
}

TEST_F(DocumentsTest, EventsAreToldOnce) {
  HealthEvents events(devices_.slots());
  EXPECT_TRUE(events.take(kNow).empty());
  devices_->health[test::kBall].publish(healthy("Spaceball 2003"));
  EXPECT_EQ(test::told(events.take(kNow)), test::Sentences{"ball: ok (Spaceball 2003)"});
  EXPECT_TRUE(events.take(kNow).empty());
  DeviceHealth lost{};
  std::snprintf(lost.reason, sizeof lost.reason, "the other end hung up");
  devices_->health[test::kBall].publish(lost);
  EXPECT_EQ(test::told(events.take(kNow)),
            test::Sentences{"fault: ball: absent (the other end hung up)"});
  std::snprintf(lost.reason, sizeof lost.reason, "stopped");
  devices_->health[test::kBall].publish(lost);
  EXPECT_EQ(test::told(events.take(kNow)), test::Sentences{"ball: absent (stopped)"});
  DeviceHealth complains = healthy("pad");
  std::snprintf(complains.reason, sizeof complains.reason, "it lacks the key BTN_8");
  devices_->health[test::kBall].publish(complains);
  EXPECT_EQ(test::told(events.take(kNow)),
            test::Sentences{"fault: ball: ok (it lacks the key BTN_8)"});
  complains.updated_ns = 0;
  devices_->health[test::kBall].publish(complains);
  EXPECT_EQ(test::told(events.take(kNow)),
            test::Sentences{"fault: ball: stale (it lacks the key BTN_8)"});
  lost.state = HealthState::kOpening;  // another attempt to open it is no event
  devices_->health[test::kBall].publish(lost);
  EXPECT_TRUE(events.take(kNow).empty());
  // it is no event either that a restarted process has not opened the device yet
  DeviceHealth starts{};
  std::snprintf(starts.reason, sizeof starts.reason, "not opened yet");
  devices_->health[test::kBall].publish(starts);
  EXPECT_TRUE(events.take(kNow).empty());
}

TEST_F(DocumentsTest, AFaultThatRecursIsToldOnceUntilItChangesOrStaysAway) {
  HealthEvents events(devices_.slots());
  Timestamp now = kNow;
  const auto enter = [&](HealthState state, const char* reason) {
    DeviceHealth health = healthy("pad");
    health.state = state;
    health.since_ns = health.updated_ns = toNanoseconds(now);
    std::snprintf(health.reason, sizeof health.reason, "%s", reason);
    devices_->health[test::kBall].publish(health);
    auto told = test::told(events.take(now));
    now += milliseconds(1500);
    return told;
  };
  const auto fails = [&](const char* reason) { return enter(HealthState::kFailed, reason); };
  const auto works = [&] { return enter(HealthState::kOk, ""); };
  const test::Sentences none, ok = {"ball: ok (pad)"};
  EXPECT_EQ(works(), ok);
  EXPECT_EQ(fails("a length of 7"), test::Sentences{"fault: ball: failed (a length of 7)"});
  EXPECT_EQ(works(), ok);
  EXPECT_EQ(fails("a length of 7"), test::Sentences{"fault: ball: failed (a length of 7)"})
      << "the last that was said is how it is";
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(works(), none);
    EXPECT_EQ(fails("a length of 7"), none);
  }
  EXPECT_EQ(works(), none);
  EXPECT_EQ(fails("a length of 8"), test::Sentences{"fault: ball: failed (a length of 8)"});
  DeviceHealth stays = healthy("pad");
  stays.since_ns = toNanoseconds(now - seconds(5));
  stays.updated_ns = toNanoseconds(now);
  devices_->health[test::kBall].publish(stays);
  EXPECT_EQ(test::told(events.take(now)), ok);
  EXPECT_EQ(fails("a length of 8"), test::Sentences{"fault: ball: failed (a length of 8)"});
  EXPECT_EQ(works(), ok) << "a fault after a while is another one";
}

// Uses real sockets in a temporary folder.
class ServerTest : public testing::Test {
 protected:
  // Starts the log before the first thread starts, as the programs do.
  static void SetUpTestSuite() { initLog(LogLevel::kWarning); }

  void SetUp() override {
    StatusServerSettings settings;
    settings.status_endpoint = status_;
    settings.command_endpoint = command_;
    settings.publications = {{"status", milliseconds(1), [] { return std::string(R"({"n":1})"); }}};
    settings.commands = {
        {"status", "", []() -> Result<std::string> { return std::string(R"({"n":1})"); }},
        {"fail", "",
         []() -> Result<std::string> {
           return Error{Errc::kIo, "it is broken"};
         }},
        {"echo", "a word", nullptr,
         [](const std::string& word) -> Result<std::string> { return '"' + word + '"'; }}};
    settings.events = [this] {
      return events_-- > 0 ? std::vector<std::string>{R"({"kind":"x"})"}
                           : std::vector<std::string>();
    };
    auto started = StatusServer::start(std::move(settings), threads_, clock_);
    ASSERT_TRUE(started) << started.error().what;
    server_ = *std::move(started);
  }

  std::string raw(const std::string& request) {
    zmq::context_t context;
    zmq::socket_t socket(context, zmq::socket_type::req);
    socket.set(zmq::sockopt::linger, 0);
    socket.set(zmq::sockopt::rcvtimeo, 10'000);
    socket.connect(command_);
    socket.send(zmq::buffer(request));
    zmq::message_t answer;
    return socket.recv(answer) ? answer.to_string() : "";
  }

  test::TempDir dir_;
  std::string status_ = "ipc://" + dir_ / "s", command_ = "ipc://" + dir_ / "c";
  SystemClock clock_;
  ThreadWatch threads_;
  std::atomic<int> events_{1'000'000};
  std::unique_ptr<StatusServer> server_;
};

TEST_F(ServerTest, AnswersCommands) {
  EXPECT_EQ(*ask(command_, "status", seconds(10)), R"({"n":1})");
  const auto failed = ask(command_, "fail", seconds(10));
  ASSERT_FALSE(failed);
  EXPECT_NE(failed.error().what.find("it is broken"), std::string::npos);
}

// Waits for the answer to the sender's last command.
Result<std::string> answerOf(CommandSender& sender, const Clock& clock) {
  std::optional<Result<std::string>> answer;
  EXPECT_TRUE(test::eventually([&] { return (answer = sender.answer(clock.now())).has_value(); }));
  return answer.value_or(Error{Errc::kTimeout, "none"});
}

TEST_F(ServerTest, ASenderSendsOneCommandAfterAnotherAndNeverWaits) {
  CommandSender sender;
  for (const char* argument : {"auto", "7"}) {
    ASSERT_TRUE(sender.isReady());
    ASSERT_TRUE(sender.send(command_, "echo", argument, clock_.now()));
    EXPECT_FALSE(sender.isReady());
    EXPECT_EQ(*answerOf(sender, clock_), fmt::format("\"{}\"", argument));
  }
  ASSERT_TRUE(sender.send(command_, "fail", "", clock_.now()));
  EXPECT_NE(answerOf(sender, clock_).error().what.find("it is broken"), std::string::npos);
  EXPECT_FALSE(sender.answer(clock_.now()));
}

TEST_F(ServerTest, ASenderGivesUpOnAServerThatIsNotThereAndFindsTheNextOne) {
  CommandSender sender;
  const Timestamp sent = clock_.now();
  ASSERT_TRUE(sender.send("ipc://" + dir_ / "nobody", "echo", "1", sent));
  EXPECT_FALSE(sender.answer(sent));
  const auto given_up = sender.answer(sent + CommandSender::kPatience);
  ASSERT_TRUE(given_up);
  EXPECT_EQ(given_up->error().code, Errc::kTimeout);
  ASSERT_TRUE(sender.isReady());
  ASSERT_TRUE(sender.send(command_, "echo", "2", clock_.now()));
  EXPECT_EQ(*answerOf(sender, clock_), "\"2\"");
}

TEST_F(ServerTest, ACommandThatWantsAnArgumentIsGivenIt) {
  EXPECT_EQ(*ask(command_, "echo", seconds(10), "auto"), R"("auto")");
  for (const char* request : {R"({"command": "echo"})", R"({"command": "echo", "argument": 5})"}) {
    const json answer = json::parse(raw(request));
    EXPECT_EQ(answer["ok"], false);
    EXPECT_NE(answer["error"].get<std::string>().find("echo needs an \"argument\""),
              std::string::npos);
  }
}

TEST_F(ServerTest, ARequestThatIsNoneSaysWhatOneIs) {
  for (const char* request :
       {"", "hello", "[]", "{}", "{\"command\": 5}", "\xFF\x00", "{\"command\": \"dance\"}"}) {
    const json answer = json::parse(raw(request));
    EXPECT_EQ(answer["ok"], false) << request;
    EXPECT_NE(answer["error"].get<std::string>().find("status, fail"), std::string::npos)
        << request;
  }
}

TEST_F(ServerTest, DeepNestingAndLongRequestsDoNotHurt) {
  EXPECT_EQ(json::parse(raw(std::string(4096, '[')))["ok"], false);
  zmq::context_t context;
  zmq::socket_t socket(context, zmq::socket_type::req);
  socket.set(zmq::sockopt::linger, 0);
  socket.connect(command_);
  // This request is too large, so it is dropped and its connection closed.
  socket.send(zmq::buffer(std::string(1 << 20, 'x')));
  EXPECT_EQ(*ask(command_, "status", seconds(10)), R"({"n":1})");
}

TEST_F(ServerTest, PublishesTopics) {
  bool status = false, event = false;
  const auto followed = follow({status_}, {"status", "event"}, seconds(10),
                               [&](const std::string& topic, const std::string& document) {
                                 status |= topic == "status" && document == R"({"n":1})";
                                 event |= topic == "event" && document == R"({"kind":"x"})";
                                 return !(status && event);
                               });
  EXPECT_TRUE(followed);
  EXPECT_TRUE(status && event);
  EXPECT_GT(threads_.threads().back().progress, 0u);
}

TEST_F(ServerTest, TellsTheLastFiftyEvents) {
  const auto count = [&] {
    const auto answer = ask(command_, "events", seconds(10));
    return answer ? json::parse(*answer).size() : 0;
  };
  EXPECT_TRUE(test::eventually([&] { return count() == 50; }));
  EXPECT_EQ(json::parse(*ask(command_, "events", seconds(10)))[49], json({{"kind", "x"}}));
  EXPECT_EQ(count(), 50U) << "not more";
}

TEST_F(ServerTest, SocketsAreForUserAndGroupOnly) {
  for (const char* name : {"s", "c"}) {
    const auto mode = fs::status(dir_ / name).permissions();
    EXPECT_EQ(mode & fs::perms::others_all, fs::perms::none);
    EXPECT_NE(mode & fs::perms::group_write, fs::perms::none);
  }
}

// ---- hostile clients

// A connection over a plain socket, without ZeroMQ.
UniqueFd rawConnection(const std::string& endpoint) {
  UniqueFd fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  endpoint.substr(6).copy(address.sun_path, sizeof address.sun_path - 1);
  if (::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    fd.reset();
  timeval patience{10, 0};
  ::setsockopt(fd.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  return fd;
}

void sendRaw(const UniqueFd& fd, const std::string& bytes) {
  (void)::send(fd.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

// Returns whether the server closes the connection; ignores everything that it sends before.
bool isClosed(const UniqueFd& fd) {
  char bytes[4096];
  for (;;) {
    const ssize_t n = ::recv(fd.get(), bytes, sizeof bytes, 0);
    if (n == 0 || (n < 0 && errno == ECONNRESET)) return true;
    if (n < 0) return false;
  }
}

const std::string kGreeting =
    std::string("\xff\0\0\0\0\0\0\0\1\x7f\3\0NULL", 16) + std::string(48, '\0');

TEST_F(ServerTest, ATwoPartRequestIsRefusedAndTheNextOneAnswered) {
  for (int i = 0; i < 3; ++i) {
    zmq::context_t context;
    zmq::socket_t socket(context, zmq::socket_type::req);
    socket.set(zmq::sockopt::linger, 0);
    socket.set(zmq::sockopt::rcvtimeo, 200);
    socket.connect(command_);
    socket.send(zmq::str_buffer("a"), zmq::send_flags::sndmore);
    socket.send(zmq::str_buffer("b"), zmq::send_flags::none);
    zmq::message_t answer;
    EXPECT_FALSE(socket.recv(answer));
    EXPECT_TRUE(ask(command_, "status", seconds(10)));
  }
  EXPECT_TRUE(test::eventually([&] { return server_->reports()[0].broken >= 3; }));
  EXPECT_NE(server_->reports()[0].last.find("not an empty part and one more"), std::string::npos);
  for (const ThreadState& thread : threads_.threads()) EXPECT_FALSE(thread.ended) << thread.name;
}

TEST_F(ServerTest, NoiseIsClosedAndEndsNothing) {
  std::uint64_t state = 1;
  for (int i = 0; i < 600; ++i) {
    std::string noise;
    for (int k = 0; k < 300; ++k) {
      state = state * 6364136223846793005U + 1442695040888963407U;
      noise.push_back(static_cast<char>(state >> 56));
    }
    const UniqueFd fd = rawConnection(i % 2 ? command_ : status_);
    if (fd.valid()) sendRaw(fd, noise);
  }
  EXPECT_TRUE(test::eventually([&] { return ask(command_, "status", seconds(1)).ok(); }));
  for (const ThreadState& thread : threads_.threads()) EXPECT_FALSE(thread.ended) << thread.name;
}

TEST_F(ServerTest, AFrameThatIsDeclaredTooLongIsClosedBeforeItComes) {
  for (const std::string& endpoint : {status_, command_}) {
    const UniqueFd fd = rawConnection(endpoint);
    ASSERT_TRUE(fd.valid());
    sendRaw(fd, kGreeting + std::string("\6\0\0\0\0\x80\0\0\0", 9));
    EXPECT_TRUE(isClosed(fd)) << endpoint;
  }
  EXPECT_NE(
      server_->reports()[1].last.find("a frame of 2147483648 bytes; at most 1024 are allowed"),
      std::string::npos)
      << server_->reports()[1].last;
}

TEST_F(ServerTest, SubscriptionsAreBounded) {
  zmq::context_t context;
  zmq::socket_t socket(context, zmq::socket_type::sub);
  socket.set(zmq::sockopt::linger, 0);
  socket.set(zmq::sockopt::reconnect_ivl, -1);
  socket.connect(status_);
  for (int i = 0; i < 40; ++i)
    socket.set(zmq::sockopt::subscribe, std::string(200, static_cast<char>('a' + i)));
  EXPECT_TRUE(test::eventually([&] { return server_->reports()[1].broken == 1; }));
  EXPECT_NE(server_->reports()[1].last.find("subscriptions of more than 4096 bytes"),
            std::string::npos)
      << server_->reports()[1].last;
}

TEST_F(ServerTest, StrangersWhoHoldEveryPlaceDoNotKeepOthersOut) {
  std::vector<UniqueFd> silent;
  for (int i = 0; i < 200; ++i) {
    silent.push_back(rawConnection(command_));
    if (i % 2 && silent.back().valid()) sendRaw(silent.back(), kGreeting);
  }
  EXPECT_TRUE(ask(command_, "status", seconds(5))) << "within five seconds";
  EXPECT_LE(server_->reports()[0].connections, 32U);
  EXPECT_GE(server_->reports()[0].sentAway(), 150U);
}

TEST_F(ServerTest, SocketsThatAreRemovedAreThereAgain) {
  for (const char* name : {"s", "c", "s.inner", "c.inner"}) fs::remove(dir_ / name);
  EXPECT_TRUE(test::eventually([&] {
    return fs::exists(dir_ / "c") && fs::exists(dir_ / "c.inner") &&
           ask(command_, "status", seconds(1)).ok();
  }));
}

// Captures what this process writes to its standard error, as long as this object lives.
class Said {
 public:
  Said() : before_(::dup(STDERR_FILENO)) {
    const UniqueFd file(::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600));
    EXPECT_GE(::dup2(file.get(), STDERR_FILENO), 0);
  }
  ~Said() { ::dup2(before_.get(), STDERR_FILENO); }
  Said(const Said&) = delete;
  Said& operator=(const Said&) = delete;

  bool eventually(const std::string& text) const {
    return test::eventually([&] { return test::readText(path_).find(text) != std::string::npos; });
  }

 private:
  test::TempDir dir_;
  std::string path_ = dir_ / "said";
  UniqueFd before_;
};

// In /run, only root can make the folder again after somebody has removed it.
TEST_F(ServerTest, SocketsWhoseFolderIsMissingForAWhileAreThereOnceItIsBack) {
  const Said said;
  ASSERT_TRUE(test::eventually([&] {  // the server makes the folder again at once
    std::error_code ignored;
    fs::remove_all(dir_.path(), ignored);
    test::writeText(dir_.path(), "");
    return fs::is_regular_file(dir_.path());
  }));
  EXPECT_TRUE(said.eventually(dir_ / "c was removed and cannot be created again"));
  EXPECT_TRUE(said.eventually("; it continues")) << "of the inner sockets";
  fs::remove(dir_.path());
  fs::create_directory(dir_.path());
  EXPECT_TRUE(test::eventually([&] { return ask(command_, "status", seconds(1)).ok(); }));
}

TEST_F(ServerTest, ASocketOfAnotherProgramInItsPlaceStays) {
  auto made = net::listenLocal(dir_ / "other", 0600);
  ASSERT_TRUE(made) << made.error().what;
  const Said said;
  fs::rename(dir_ / "other", dir_ / "c");
  EXPECT_TRUE(said.eventually("another program serves this socket"));
  server_.reset();
  EXPECT_TRUE(fs::is_socket(dir_ / "c"));
}

TEST_F(ServerTest, ACleanStopLeavesNoSocket) {
  server_.reset();
  EXPECT_TRUE(fs::is_empty(dir_.path()));
}

// The run could not be followed at first, for example because too many files were open; it may go
// on for months.
TEST(RoleFollower, ConnectsToARunThatItCouldNotFollowAtFirst) {
  using Wall = shm::WallSegment;
  const test::TempDir dir;
  const std::string instance = test::privateName("follower"), endpoint = "ipc://" + dir / "s";
  Timestamp now = kNow;
  auto wall = shm::SegmentWriter<Wall>::make(shm::segmentName(instance, "wall"), shm::wallFields(),
                                             7, now, {"of no kind that ZeroMQ knows", ""});
  ASSERT_TRUE(wall) << wall.error().what;
  RoleFollower<shm::SegmentReader<Wall>> follower(instance, "wall", {"event"});
  const auto look = [&] {
    now += milliseconds(500);
    wall->writeHeartbeat(now);
    return follower.update(now);
  };
  EXPECT_TRUE(look());
  EXPECT_EQ(follower.generation(), 7u);
  auto& header = (**wall).header;
  std::snprintf(header.status_endpoint, sizeof header.status_endpoint, "%s", endpoint.c_str());
  zmq::context_t context;
  zmq::socket_t publisher(context, zmq::socket_type::pub);
  publisher.set(zmq::sockopt::linger, 0);
  publisher.bind(endpoint);
  EXPECT_TRUE(test::eventually([&] {
    EXPECT_FALSE(look()) << "it is the same run";
    publisher.send(zmq::str_buffer("event"), zmq::send_flags::sndmore);
    publisher.send(zmq::str_buffer("{}"), zmq::send_flags::none);
    return follower.take().has_value();
  }));
}

TEST(Server, AnEndpointThatCannotBeBoundIsNamed) {
  StatusServerSettings settings;
  settings.status_endpoint = "ipc:///no/such/folder/s";
  settings.events = [] { return std::vector<std::string>(); };
  const SystemClock clock;
  ThreadWatch threads;
  const auto started = StatusServer::start(std::move(settings), threads, clock);
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().what.find("ipc:///no/such/folder/s"), std::string::npos);
}

TEST(Client, ASilentDaemonIsATimeOut) {
  const test::TempDir dir;
  EXPECT_EQ(ask("ipc://" + dir / "nobody", "status", milliseconds(20)).error().code,
            Errc::kTimeout);
  EXPECT_EQ(
      follow({"ipc://" + dir / "nobody"}, {""}, milliseconds(20), [](auto&, auto&) { return true; })
          .error()
          .code,
      Errc::kTimeout);
}

TEST(Watchdog, PingsOnlyWhileEachThreadMakesProgress) {
  Watchdog watchdog(seconds(2));
  const auto ping = [&](int at, std::uint64_t first, std::uint64_t second) {
    return watchdog.ping(kNow + seconds(at), {{1, "first", first, false, false, ""},
                                              {2, "second", second, false, false, ""}});
  };
  EXPECT_TRUE(ping(0, 0, 0));
  EXPECT_FALSE(ping(1, 5, 5)) << "not due";
  EXPECT_TRUE(ping(2, 5, 5));
  EXPECT_FALSE(ping(4, 1000, 5)) << "the second one is stuck, whatever the first does";
  EXPECT_FALSE(ping(6, 2000, 5));
  EXPECT_TRUE(ping(8, 2001, 6));
  EXPECT_FALSE(Watchdog(Duration::zero()).ping(kNow, {}));
}

TEST(Watchdog, KnowsThreadsThatPauseEndStopAndStart) {
  Watchdog watchdog(seconds(2));
  ThreadState a{1, "a", 7, false, false, ""}, b{2, "b", 7, false, false, ""};
  EXPECT_TRUE(watchdog.ping(kNow, {a, b}));
  a.progress = 8;
  b.paused = true;
  EXPECT_TRUE(watchdog.ping(kNow + seconds(2), {a, b})) << "in a call that may take long";
  a.progress = 9;
  EXPECT_TRUE(watchdog.ping(kNow + seconds(4), {a, {3, "c", 0, false, false, ""}}))
      << "b was stopped, c is new";
  a.progress = 10;
  EXPECT_FALSE(watchdog.ping(kNow + seconds(6), {a, {3, "c", 5, false, true, "gone"}}));
}

// When strangers hold all places, a daemon closes connections, and requests on these connections
// are lost.
TEST(Client, AsksForTheStatusAgainAndForNothingElse) {
  const test::TempDir dir;
  const std::string endpoint = "ipc://" + dir.path() + "/c";
  zmq::context_t context{1};
  zmq::socket_t router{context, zmq::socket_type::router};
  router.bind(endpoint);
  std::atomic<int> heard{0};
  const std::jthread server([&](const std::stop_token& stop) {
    router.set(zmq::sockopt::rcvtimeo, 20);
    while (!stop.stop_requested()) {
      zmq::message_t from, empty, request;
      if (!router.recv(from) || !router.recv(empty) || !router.recv(request)) continue;
      if (++heard != 2) continue;  // answers the second request only
      router.send(from, zmq::send_flags::sndmore);
      router.send(empty, zmq::send_flags::sndmore);
      router.send(zmq::str_buffer(R"({"ok": true, "result": 5})"), zmq::send_flags::none);
    }
  });
  const auto answer = ask(endpoint, "status", seconds(20));
  ASSERT_TRUE(answer) << answer.error().what;
  EXPECT_EQ(*answer, "5");
  EXPECT_EQ(heard, 2);
  EXPECT_EQ(ask(endpoint, "next_content", milliseconds(1500)).error().what,
            endpoint + ": no answer within 1.5 s");
  EXPECT_EQ(heard, 3) << "it might have been executed already";
}

TEST(RunDirectory, IsMadeAndRefusedWhereItIsNotOurs) {
  const test::TempDir dir;
  EXPECT_EQ(*runDirectory(dir / "a/b"), dir / "a/b");
  EXPECT_TRUE(std::filesystem::is_directory(dir / "a/b"));
  EXPECT_FALSE(runDirectory("/proc/nothing/here"));
  EXPECT_FALSE(runDirectory(dir / std::string(90, 'x'))) << "too long for a socket's name";
  std::filesystem::create_directory_symlink("/tmp", dir / "link");
  EXPECT_FALSE(runDirectory(dir / "link"));
  std::filesystem::create_directory(dir / "open");
  ASSERT_EQ(::chmod((dir / "open").c_str(), 0777), 0);
  EXPECT_FALSE(runDirectory(dir / "open")) << "everybody may write to it";
  if (::geteuid() != 0) return;  // only root can change a folder's owner
  for (const char* given : {"given", "tmp/given"}) {
    std::filesystem::create_directories(dir / given);
    ASSERT_EQ(::chown((dir / given).c_str(), 65534, 65534), 0);
  }
  EXPECT_TRUE(runDirectory(dir / "given")) << "a service's, that root checks";
  ASSERT_EQ(::chmod((dir / "tmp").c_str(), 01777), 0);
  EXPECT_FALSE(runDirectory(dir / "tmp/given")) << "whoever made it there";
}

}  // namespace
}  // namespace merlin::status
