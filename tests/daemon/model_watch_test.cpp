// When the wall reads a model file again that was replaced while the wall runs.
#include "daemon/wall/model_watch.h"

#include <filesystem>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/eventually.h"
#include "tests/support/fake_clock.h"
#include "tests/support/temp_dir.h"
#include "tests/support/told.h"

namespace merlin::wall {
namespace {

using std::chrono::milliseconds;

FileStamp stamp(std::uint64_t size, std::int64_t modified_ns) {
  return {1, 2, size, modified_ns, modified_ns};
}

TEST(ReplacedFile, IsReadOnceItHasStayedTheSameForASecond) {
  ReplacedFile file(stamp(100, 1));
  Timestamp now{};
  const auto look = [&](const std::optional<FileStamp>& found, int after_ms) {
    now += milliseconds(after_ms);
    return file.look(found, now);
  };
  EXPECT_FALSE(look(stamp(100, 1), 5000)) << "what is shown";
  EXPECT_FALSE(look(stamp(40, 2), 500)) << "a copy has begun";
  EXPECT_FALSE(look(stamp(80, 3), 900));
  EXPECT_FALSE(look(stamp(80, 3), 900)) << "not for a second yet";
  EXPECT_FALSE(look(std::nullopt, 900)) << "between two names";
  EXPECT_TRUE(look(stamp(80, 3), 100));
  EXPECT_FALSE(look(stamp(80, 3), 5000)) << "once";
  EXPECT_FALSE(look(stamp(100, 1), 500));
  EXPECT_TRUE(look(stamp(100, 1), 1000)) << "the first one is back";
}

TEST(ReplacedFile, ThatComesBackBeforeItIsReadIsNoOther) {
  ReplacedFile file(stamp(100, 1));
  EXPECT_FALSE(file.look(stamp(1, 2), Timestamp(milliseconds(0))));
  EXPECT_FALSE(file.look(stamp(100, 1), Timestamp(milliseconds(500))));
  EXPECT_FALSE(file.look(stamp(100, 1), Timestamp(milliseconds(5000))));
}

TEST(ModelWatch, OffersTheNewestOfAPlaceAndSaysWhyOneIsRefused) {
  const test::TempDir dir;
  test::writeText(dir / "good", "1");
  test::writeText(dir / "bad", "1");
  ThreadWatch watch;
  const SystemClock clock;
  const auto make = [&](std::size_t place, const std::string& path) -> Result<ReadyModel> {
    if (path == dir / "bad") return Error{Errc::kMalformed, path + ": is damaged"};
    return ReadyModel{place, test::readText(path), nullptr, nullptr};
  };
  MissingContents missing({});
  ModelWatch models({{dir / "bad", *fileStamp(dir / "bad")}, {dir / "good", FileStamp{}}}, make,
                    missing, watch, clock);
  std::optional<ReadyModel> ready;
  ASSERT_TRUE(test::eventually([&] { return (ready = models.take()).has_value(); }));
  EXPECT_EQ(ready->place, 1u) << "it was another one when it was read";
  EXPECT_TRUE(models.takeEvents().empty());
  test::writeText(dir / "bad", "22");
  test::Sentences events;
  ASSERT_TRUE(
      test::eventually([&] { return !(events = test::told(models.takeEvents())).empty(); }));
  EXPECT_EQ(events.front(), "fault: the model's file was replaced by one that cannot be shown (" +
                                (dir / "bad") +
                                ": is damaged); the model that was read before stays");
  EXPECT_FALSE(models.take());
  std::filesystem::remove(dir / "good");
  ASSERT_TRUE(
      test::eventually([&] { return !(events = test::told(models.takeEvents())).empty(); }));
  EXPECT_NE(events.front().find(dir / "good is gone"), std::string::npos) << events.front();
  test::writeText(dir / "good", "1");
  ASSERT_TRUE(
      test::eventually([&] { return !(events = test::told(models.takeEvents())).empty(); }));
  EXPECT_FALSE(events.front().starts_with("fault")) << events.front();
  EXPECT_NE(events.front().find("is there again"), std::string::npos) << events.front();
}

// The folder is read for each slide. A file in the folder that cannot be shown is reported only
// once while that lasts.
TEST(ModelWatch, SaysOnceWhatAFolderOfSlidesHasThatIsNotShown) {
  ThreadWatch watch;
  const SystemClock clock;
  MissingContents missing({});
  const auto make = [](std::size_t, const std::string& path) -> Result<ReadyModel> {
    return Error{Errc::kIo, path};
  };
  ModelWatch models({{"/talk/a.tif", {}, "picture", "", "z.jpg is no pyramid"}}, make, missing,
                    watch, clock);
  const auto offer = [&](const std::string& path, const std::string& left_out) {
    ReadyModel slide;
    slide.path = path;
    slide.is_slide = true;
    slide.left_out = left_out;
    models.offer(std::move(slide));
    return test::told(models.takeEvents());
  };
  EXPECT_EQ(test::told(models.takeEvents()), test::Sentences{"fault: z.jpg is no pyramid"});
  EXPECT_EQ(offer("/talk/b.tif", "z.jpg is no pyramid"), test::Sentences{});
  EXPECT_EQ(offer("/other/a.tif", "z.jpg is no pyramid").size(), 1U) << "another folder";
  EXPECT_EQ(offer("/talk/c.tif", "y.jpg, z.jpg are no pyramids").size(), 1U);
  EXPECT_EQ(offer("/talk/a.tif", "").size(), 0U);
  EXPECT_EQ(offer("/talk/b.tif", "z.jpg is no pyramid").size(), 1U) << "it is there again";
}

// A damaged slide is skipped each time that its turn comes, but reported at most once an hour.
TEST(ModelWatch, SaysOnceAnHourThatASlideIsLeftOut) {
  ThreadWatch watch;
  test::FakeClock clock;
  MissingContents missing({});
  const auto make = [](std::size_t, const std::string& path) -> Result<ReadyModel> {
    return Error{Errc::kIo, path};
  };
  ModelWatch models({}, make, missing, watch, clock);
  const auto saidAfter = [&](Duration time, const std::vector<std::string>& skipped) {
    clock.advance(time);
    models.reportSkipped(skipped);
    return test::told(models.takeEvents());
  };
  const test::Sentences both = {"fault: b.tif is cut", "fault: c.tif is cut"};
  EXPECT_EQ(saidAfter(milliseconds(0), {"b.tif is cut", "c.tif is cut"}), both);
  EXPECT_EQ(saidAfter(std::chrono::minutes(40), {"b.tif is cut"}), test::Sentences{});
  EXPECT_EQ(saidAfter(std::chrono::minutes(10), {"b.tif is cut", "d.tif is cut"}),
            test::Sentences{"fault: d.tif is cut"});
  EXPECT_EQ(saidAfter(std::chrono::minutes(10), {"b.tif is cut", "c.tif is cut"}), both);
}

TEST(ModelWatch, ReadsWhatWasMissingAsSoonAsItIsThere) {
  const test::TempDir dir;
  const std::string folder = dir / "slides", file = dir / "late";
  ThreadWatch watch;
  const SystemClock clock;
  int tries = 0;
  const auto make = [&](std::size_t place, const std::string& path) -> Result<ReadyModel> {
    // This simulates a file that is still being written after the folder's time stamp has changed
    // for the last time.
    if (path == folder && ++tries == 1) return Error{Errc::kMalformed, "is cut"};
    if (path == folder) return ReadyModel{place, folder + "/first", nullptr, nullptr};
    if (test::readText(path) == "good") {
      ReadyModel ready{place, path, nullptr, nullptr};
      ready.stamp = *fileStamp(path);
      return ready;
    }
    return Error{Errc::kMalformed, path + ": is damaged"};
  };
  MissingContents missing({"there is no such file", "there is no such folder"});
  ModelWatch models(
      {{file, {}, "picture", missing.faultOf(0)}, {folder, {}, "picture", missing.faultOf(1)}},
      make, missing, watch, clock, std::chrono::milliseconds(1));
  test::Sentences events = test::told(models.takeEvents());
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events.front(),
            "fault: " + file + " is left out until it can be read: there is no such file");
  const auto told = [&] {
    return test::eventually([&] { return !(events = test::told(models.takeEvents())).empty(); });
  };
  test::writeText(file, "bad");
  ASSERT_TRUE(told());
  EXPECT_EQ(events.front(), "fault: " + file + " is still left out: " + file + ": is damaged");
  EXPECT_EQ(missing.faultOf(0), file + ": is damaged");
  EXPECT_FALSE(models.take());
  test::writeText(file, "good");
  std::optional<ReadyModel> ready;
  ASSERT_TRUE(test::eventually([&] { return (ready = models.take()).has_value(); }));
  EXPECT_NE(missing.faultOf(0), "") << "until the wall says that it is there";
  EXPECT_EQ(ready->place, 0u);
  EXPECT_FALSE(ready->was_replaced || ready->asked_for);
  std::filesystem::create_directory(folder);
  ASSERT_TRUE(test::eventually([&] { return (ready = models.take()).has_value(); }));
  EXPECT_EQ(ready->path, folder + "/first") << "tried again";
  EXPECT_EQ(missing.faultOf(1), "is cut");
}

}  // namespace
}  // namespace merlin::wall
