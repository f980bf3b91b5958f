// The devices of another machine: the samples document of one end reaches the shared memory of the
// other end over a real, encrypted socket.
#include "daemon/status/sample_link.h"

#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/status/documents.h"
#include "daemon/status/server.h"
#include "tests/support/eventually.h"
#include "tests/support/local_devices.h"
#include "tests/support/temp_dir.h"

namespace merlin::status {
namespace {

test::LocalDevices filled(std::int64_t received_ns, std::uint32_t counter) {
  test::LocalDevices segment;
  GloveSample glove{};
  glove.received_ns = received_ns;
  glove.counter = counter;
  glove.sensors = 22;
  glove.angle_rad[4] = 1.234567F;
  glove.raw[4] = 201;
  segment->glove[0].samples.publish(glove);
  TrackerSample tracker{};
  tracker.received_ns = received_ns;
  tracker.counter = counter;
  tracker.station = 2;
  tracker.position_m[1] = -0.123456F;
  tracker.orientation_wxyz[0] = 1;
  tracker.error = 'k';
  segment->tracker[0].stations[1].publish(tracker);
  BallSample ball{};
  ball.received_ns = received_ns;
  ball.counter = counter;
  ball.rotation[2] = -0.5F;
  ball.raw[5] = -800;
  ball.buttons = 0x101;
  ball.keys[1] = 57;
  segment->ball[0].publish(ball);
  PostureSample posture{};
  posture.received_ns = posture.since_ns = received_ns;
  posture.counter = counter;
  posture.code = 3;
  std::snprintf(posture.name, sizeof posture.name, "fist");
  segment->glove[0].posture.publish(posture);
  HandSample hand{};
  hand.received_ns = received_ns;
  hand.counter = counter;
  hand.orientation_wxyz[0] = 1;
  hand.velocity_m_s[0] = 0.25F;
  segment->hand[0].publish(hand);
  GestureState gesture{};
  gesture.received_ns = received_ns;
  gesture.began_ns = received_ns - 300;
  gesture.counter = counter;
  gesture.passed_over = 2;
  gesture.certainty = 0.75F;
  std::snprintf(gesture.name, sizeof gesture.name, "swipe_left");
  segment->gesture[0].publish(gesture);
  shm::ActionState begun{};
  begun.generation = 5;
  begun.begun[2] = counter;
  segment->actions[shm::kFirstHandSource].publish(begun);
  for (std::size_t i = 0; i < test::defaultSlotNames().devices.size(); ++i) {
    DeviceHealth health{};
    health.state = i == test::kTracker ? HealthState::kFailed : HealthState::kOk;
    std::snprintf(health.reason, sizeof health.reason, "reason %d", static_cast<int>(i));
    segment->health[i].publish(health);
  }
  return segment;
}

TEST(ApplySamples, BringsEverythingOverAsOldAsItWas) {
  const auto there = filled(5'000'000'000, 7);
  const auto here = std::make_unique<shm::DevicesSegment>();
  const std::string document = newestSamples(there.slots(), fromNanoseconds(5'010'000'000));
  const Timestamp now = fromNanoseconds(99'000'000'000);
  ASSERT_TRUE(applySamples(document, "tcp://a:1", now, test::defaultSlotNames(), *here));
  const auto glove = here->glove[0].samples.newest();
  ASSERT_TRUE(glove);
  EXPECT_EQ(glove->received_ns, 98'990'000'000) << "10 ms old";
  EXPECT_EQ(glove->counter, 7u);
  EXPECT_NEAR(glove->angle_rad[4], 1.234567F, 1e-6F);
  EXPECT_EQ(glove->raw[4], 201);
  EXPECT_EQ(glove->sensors, 22u);
  const auto tracker = here->tracker[0].stations[1].newest();
  ASSERT_TRUE(tracker);
  EXPECT_NEAR(tracker->position_m[1], -0.123456F, 1e-6F);
  EXPECT_EQ(tracker->error, 'k');
  EXPECT_FALSE(here->tracker[0].stations[0].newest());
  EXPECT_EQ(here->ball[0].newest()->raw[5], -800);
  EXPECT_EQ(here->ball[0].newest()->buttons, 0x101u);
  EXPECT_STREQ(here->glove[0].posture.newest()->name, "fist");
  EXPECT_EQ(here->glove[0].posture.newest()->since_ns, 98'990'000'000);
  EXPECT_FLOAT_EQ(here->hand[0].newest()->velocity_m_s[0], 0.25F);
  EXPECT_EQ(here->ball[0].newest()->keys[1], 57u);
  const auto gesture = here->gesture[0].read();
  ASSERT_TRUE(gesture);
  EXPECT_STREQ(gesture->name, "swipe_left");
  EXPECT_EQ(gesture->received_ns, 98'990'000'000);
  EXPECT_EQ(gesture->began_ns, 98'989'999'700);
  EXPECT_EQ(gesture->counter, 7u);
  EXPECT_EQ(gesture->passed_over, 2u);
  EXPECT_EQ(gesture->certainty, 0.75F);
  EXPECT_EQ(here->actions[shm::kFirstHandSource].read()->begun[2], 7u);
  EXPECT_EQ(here->health[test::kTracker].read()->state, HealthState::kFailed);
  EXPECT_STREQ(here->health[test::kTracker].read()->reason, "reason 1");
  EXPECT_STREQ(here->health[test::kBall].read()->port, "tcp://a:1");
}

// The moves of an output's corner are taken from this list.
TEST(ApplySamples, ListsTheActionsThatBeganBetweenTwoDocuments) {
  const auto here = std::make_unique<shm::DevicesSegment>();
  const auto apply = [&](std::uint32_t counter) {
    EXPECT_TRUE(applySamples(newestSamples(filled(1, counter).slots(), fromNanoseconds(2)), "", {},
                             test::defaultSlotNames(), *here));
    return *here->actions[shm::kFirstHandSource].read();
  };
  EXPECT_EQ(apply(7).sequence, 0u) << "what began before is not executed";
  const shm::ActionState next = apply(9);
  EXPECT_EQ(next.sequence, 2u);
  EXPECT_EQ(next.recent[0], 2);
  EXPECT_EQ(next.recent[1], 2);
  EXPECT_EQ(apply(9).sequence, 2u);
  EXPECT_EQ(apply(1000).sequence, 2u + sizeof next.recent) << "as many as there is room for";
  EXPECT_EQ(apply(3).sequence, 2u + sizeof next.recent) << "a count that falls is no action";
}

TEST(ApplySamples, TheSameSampleIsPublishedOnce) {
  const auto there = filled(1, 7);
  const auto here = std::make_unique<shm::DevicesSegment>();
  for (int i = 0; i < 3; ++i)
    ASSERT_TRUE(applySamples(newestSamples(there.slots(), fromNanoseconds(2)), "", {},
                             test::defaultSlotNames(), *here));
  EXPECT_EQ(here->ball[0].count(), 1u);
  ASSERT_TRUE(applySamples(newestSamples(filled(3, 8).slots(), fromNanoseconds(4)), "", {},
                           test::defaultSlotNames(), *here));
  EXPECT_EQ(here->ball[0].count(), 2u);
}

TEST(ApplySamples, NonsenseIsRefusedAndHalfTruthsDoNoHarm) {
  const auto here = std::make_unique<shm::DevicesSegment>();
  for (const char* bad : {"", "[]", "{}", "{\"now_ns\":", "7"})
    EXPECT_FALSE(applySamples(bad, "", {}, test::defaultSlotNames(), *here)) << bad;
  for (const char* odd :
       {R"({"now_ns":1,"ball":7,"tracker":{},"hand":[],"health":3,"posture":"x"})",
        R"({"now_ns":1,"tracker":[{"station":9},{"station":"x"},7,{"error":"long"}]})",
        R"({"now_ns":"x","glove":{"angle_rad":[1,2],"raw":"y","counter":{}}})",
        R"({"now_ns":1,"health":{"ball":{"state":99,"reason":5}}})"}) {
    EXPECT_TRUE(applySamples(odd, "", {}, test::defaultSlotNames(), *here)) << odd;
  }
  const std::string good = newestSamples(filled(1, 1).slots(), {});
  for (std::size_t n = 0; n < good.size(); n += 7)
    EXPECT_FALSE(applySamples(good.substr(0, n), "", {}, test::defaultSlotNames(), *here));
}

TEST(ApplySamples, WhatNoDeviceCanMeasureIsNotTaken) {
  const auto there = filled(1, 1);
  TrackerSample far = *there->tracker[0].stations[1].newest();
  far.counter = 2;
  far.position_m[0] = 1e30F;
  there->tracker[0].stations[1].publish(far);
  BallSample ball = *there->ball[0].newest();
  ball.counter = 2;
  ball.rotation[2] = 3;
  there->ball[0].publish(ball);
  const auto here = std::make_unique<shm::DevicesSegment>();
  ASSERT_TRUE(
      applySamples(newestSamples(there.slots(), {}), "", {}, test::defaultSlotNames(), *here));
  EXPECT_EQ(here->tracker[0].stations[1].count(), 0U);
  EXPECT_EQ(here->ball[0].count(), 0U);
  EXPECT_EQ(here->glove[0].samples.count(), 1U) << "the others are";
}

TEST(ApplySamples, ATimeThatCannotBeIsNone) {
  const auto here = std::make_unique<shm::DevicesSegment>();
  ASSERT_TRUE(applySamples(
      R"({"now_ns":9223372036854775807,"ball":{"received_ns":-9223372036854775807,"counter":1}})",
      "", fromNanoseconds(5), test::defaultSlotNames(), *here));
  ASSERT_EQ(here->ball[0].count(), 1U);
  EXPECT_EQ(here->ball[0].newest()->received_ns, 0);
}

TEST(Keys, AreWrittenForTheirOwnerAloneAndReadBack) {
  const test::TempDir dir;
  const auto keys = makeKeyPair();
  ASSERT_TRUE(keys);
  ASSERT_TRUE(writeKeyPair(dir / "keys", *keys));
  struct stat status {};
  ASSERT_EQ(::stat((dir / "keys").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
  const auto back = readKeyPair(dir / "keys");
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->secret_key, keys->secret_key);
  test::writeText(dir / "clients", "# the wall's\n" + keys->public_key + " # hall\n\n");
  EXPECT_EQ(*readPublicKeys(dir / "clients"), std::vector<std::string>{keys->public_key});
  test::writeText(dir / "clients", "short\n");
  EXPECT_NE(readPublicKeys(dir / "clients").error().what.find("line 1"), std::string::npos);
  EXPECT_EQ(readKeyPair(dir / "clients").error().code, Errc::kMalformed);
}

// A daemon that offers its devices' samples at a network socket.
struct Devices {
  Devices(const test::TempDir& dir, int port, const KeyPair& keys, std::vector<std::string> clients)
      : segment(filled(toNanoseconds(clock.now()), 1)) {
    StatusServerSettings s;
    s.status_endpoint = "ipc://" + dir / "status";
    s.command_endpoint = "ipc://" + dir / "command";
    s.network = {"tcp://127.0.0.1:" + std::to_string(port), keys, Door{std::move(clients), {}}};
    s.publications = {{"sample", std::chrono::milliseconds(10),
                       [this] { return newestSamples(segment.slots(), clock.now()); }}};
    s.events = [] { return std::vector<std::string>(); };
    auto started = StatusServer::start(std::move(s), threads, clock);
    EXPECT_TRUE(started) << started.error().what;
    if (!started) return;
    server = *std::move(started);
    auto relay = server->startNetworkTopics(threads);
    EXPECT_TRUE(relay) << relay.error().what;
    if (relay) samples = *std::move(relay);
  }
  void stop() {
    samples.reset();
    server.reset();
  }
  SystemClock clock;
  ThreadWatch threads;
  test::LocalDevices segment;
  std::unique_ptr<StatusServer> server;
  // uses `server`, so it is declared after it and destroyed first
  std::unique_ptr<net::Server> samples;
};

HealthState ballOf(const shm::DevicesSegment& segment) {
  const auto health = segment.health[test::kBall].read();
  return health ? health->state : HealthState::kAbsent;
}

TEST(SampleLink, FollowsSaysWhenItIsGoneAndComesBackByItself) {
  const test::TempDir dir;
  const int port = 20000 + ::getpid() % 20000;
  const KeyPair server = *makeKeyPair(), client = *makeKeyPair();
  const SystemClock clock;
  ThreadWatch threads;
  const auto here = std::make_unique<shm::DevicesSegment>();
  SampleLinkSettings settings;
  settings.endpoint = "tcp://127.0.0.1:" + std::to_string(port);
  settings.server_key = server.public_key;
  settings.keys = client;
  const auto link = SampleLink::start(settings, test::defaultSlotNames(), *here, threads, clock);
  ASSERT_TRUE(link) << link.error().what;
  ASSERT_TRUE(test::eventually([&] { return here->health[test::kBall].read().has_value(); }));
  EXPECT_NE(std::string(here->health[test::kBall].read()->reason).find("yet"), std::string::npos);
  for (int times = 0; times < 2; ++times) {
    Devices devices(dir, port, server, {client.public_key});
    ASSERT_TRUE(test::eventually([&] { return ballOf(*here) == HealthState::kOk; })) << times;
    EXPECT_EQ(here->ball[0].newest()->buttons, 0x101u);
    devices.stop();
    ASSERT_TRUE(test::eventually([&] { return ballOf(*here) == HealthState::kAbsent; }));
    EXPECT_EQ(std::string(here->health[test::kBall].read()->reason),
              "nothing received from " + settings.endpoint + ": the link is lost");
  }
}

TEST(SampleLink, AStrangersKeyHearsNothing) {
  const test::TempDir dir;
  const int port = 20000 + (::getpid() + 7919) % 20000;
  const KeyPair server = *makeKeyPair(), friends = *makeKeyPair(), stranger = *makeKeyPair();
  const SystemClock clock;
  ThreadWatch threads;
  const auto theirs = std::make_unique<shm::DevicesSegment>();
  const auto ours = std::make_unique<shm::DevicesSegment>();
  Devices devices(dir, port, server, {friends.public_key});
  const std::string endpoint = "tcp://127.0.0.1:" + std::to_string(port);
  const auto bad = SampleLink::start({endpoint, server.public_key, stranger},
                                     test::defaultSlotNames(), *theirs, threads, clock);
  const auto good = SampleLink::start({endpoint, server.public_key, friends},
                                      test::defaultSlotNames(), *ours, threads, clock);
  ASSERT_TRUE(bad && good);
  ASSERT_TRUE(test::eventually([&] { return ours->ball[0].count() > 0; }));
  EXPECT_EQ(theirs->ball[0].count(), 0u);
}

// In a usual installation, the daemon lists the wall's key only after the wall's first attempt.
TEST(SampleLink, AKeyThatIsListedLaterIsHeardAfterTheOthersRestart) {
  const test::TempDir dir;
  const int port = 20000 + (::getpid() + 3571) % 20000;
  const KeyPair server = *makeKeyPair(), ours = *makeKeyPair(), other = *makeKeyPair();
  const SystemClock clock;
  ThreadWatch threads;
  const auto here = std::make_unique<shm::DevicesSegment>();
  SampleLinkSettings settings{"tcp://127.0.0.1:" + std::to_string(port), server.public_key, ours};
  settings.renew_after = settings.renew_at_most = std::chrono::milliseconds(300);
  auto devices = std::make_unique<Devices>(dir, port, server, std::vector{other.public_key});
  const auto link = SampleLink::start(settings, test::defaultSlotNames(), *here, threads, clock);
  ASSERT_TRUE(link) << link.error().what;
  // At first the daemon accepts the TCP connection, but refuses the wall's key at least once.
  ASSERT_TRUE(test::eventually([&] { return devices->samples->report().accepted > 0; }));
  devices->stop();
  devices = std::make_unique<Devices>(dir, port, server, std::vector{ours.public_key});
  EXPECT_TRUE(test::eventually([&] { return ballOf(*here) == HealthState::kOk; }));
}

TEST(SampleLink, ComesBackAfterAnotherProgramAnsweredOnThePort) {
  const test::TempDir dir;
  const int port = 20000 + (::getpid() + 4567) % 20000;
  const KeyPair server = *makeKeyPair(), ours = *makeKeyPair();
  const SystemClock clock;
  ThreadWatch threads;
  const auto here = std::make_unique<shm::DevicesSegment>();
  SampleLinkSettings settings{"tcp://127.0.0.1:" + std::to_string(port), server.public_key, ours};
  settings.renew_after = settings.renew_at_most = std::chrono::milliseconds(300);
  auto listener = net::listenTcp("127.0.0.1", port);
  ASSERT_TRUE(listener) << listener.error().what;
  const auto link = SampleLink::start(settings, test::defaultSlotNames(), *here, threads, clock);
  ASSERT_TRUE(link) << link.error().what;
  UniqueFd web;
  ASSERT_TRUE(test::eventually([&] {
    web.reset(::accept(listener->get(), nullptr, nullptr));
    return web.valid();
  }));
  const std::string answer =
      "HTTP/1.1 400 Bad Request\r\nConnection: close\r\n\r\n" + std::string(200, ' ');
  ASSERT_GT(::send(web.get(), answer.data(), answer.size(), MSG_NOSIGNAL), 0);
  web.reset();
  listener->reset();
  Devices devices(dir, port, server, {ours.public_key});
  EXPECT_TRUE(test::eventually([&] { return ballOf(*here) == HealthState::kOk; }));
}

TEST(SampleLink, SaysThatAKeyOrAnAddressIsNone) {
  const auto here = std::make_unique<shm::DevicesSegment>();
  const SystemClock clock;
  ThreadWatch threads;
  const KeyPair keys = *makeKeyPair();
  EXPECT_EQ(SampleLink::start({"tcp://127.0.0.1:1", "short", keys}, test::defaultSlotNames(), *here,
                              threads, clock)
                .error()
                .code,
            Errc::kInvalidArgument);
  EXPECT_EQ(SampleLink::start({"nonsense", keys.public_key, keys}, test::defaultSlotNames(), *here,
                              threads, clock)
                .error()
                .code,
            Errc::kInvalidArgument);
}

}  // namespace
}  // namespace merlin::status
