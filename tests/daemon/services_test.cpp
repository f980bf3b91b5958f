#include "daemon/status/services.h"

#include <stdexcept>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/status/ended_threads.h"
#include "tests/support/eventually.h"
#include "tests/support/told.h"

namespace merlin::status {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using test::Sentences;
using test::told;

TEST(Services, AChangeIsAnEventOnceAndTheStateStands) {
  Services services;
  EXPECT_EQ(services.addTo("{\"a\": 1}"), "{\"a\": 1}");
  services.ok("picture");
  EXPECT_TRUE(services.takeEvents().empty());
  services.failed("picture", "no \"disk\"");
  services.failed("picture", "no \"disk\"");
  EXPECT_EQ(told(services.takeEvents()), Sentences{"fault: picture: failed (no \"disk\")"});
  const json failed = json::parse(services.addTo("{\"a\": 1}"));
  EXPECT_EQ(failed["a"], 1);
  EXPECT_EQ(failed["services"]["picture"]["health"], "failed");
  EXPECT_EQ(failed["services"]["picture"]["reason"], "no \"disk\"");
  services.ok("picture");
  EXPECT_EQ(told(services.takeEvents()), Sentences{"picture: works again"});
  EXPECT_EQ(json::parse(services.addTo("{}"))["services"]["picture"]["health"], "ok");
}

TEST(EndedThreads, OneThatEndsIsSaidAndThenEndsTheDaemon) {
  ThreadWatch watch;
  Services services;
  EndedThreads ended(watch, services);
  const WatchedThread works(watch, "wall", [](const std::stop_token& stop, Progress&) {
    while (!stop.stop_requested()) std::this_thread::yield();
  });
  EXPECT_FALSE(ended.check(Timestamp(milliseconds(0))));
  const WatchedThread dies(watch, "glove", [](const std::stop_token&, Progress&) {
    throw std::runtime_error("no memory");
  });
  ASSERT_TRUE(test::eventually([&] { return watch.threads()[1].ended; }));
  EXPECT_FALSE(ended.check(Timestamp(milliseconds(1000)))) << "first it is said";
  EXPECT_EQ(told(services.takeEvents()), Sentences{"fault: thread glove: failed (no memory)"});
  EXPECT_FALSE(ended.check(Timestamp(milliseconds(1400))));
  const auto error = ended.check(Timestamp(milliseconds(1500)));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, Errc::kIo) << "merlind exits 1";
  EXPECT_EQ(error->what, "the thread \"glove\" has ended: no memory");
}

}  // namespace
}  // namespace merlin::status
