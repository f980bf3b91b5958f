// daemon/base: files, text, clocks.
#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/base/bytes.h"
#include "daemon/base/child_work.h"
#include "daemon/base/clock.h"
#include "daemon/base/dated_files.h"
#include "daemon/base/did_you_mean.h"
#include "daemon/base/dma_buf.h"
#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"
#include "daemon/base/random.h"
#include "daemon/base/sanitizer.h"
#include "tests/support/temp_dir.h"

namespace merlin {
namespace {

TEST(Text, IsUtf8WithoutControls) {
  for (const char* text : {"", "heat", "\xc2\xb5", "\xe2\x84\x83", "\xf0\x9f\xa6\x96",
                           "\xed\x9f\xbf", "\xf4\x8f\xbf\xbf"})
    EXPECT_TRUE(isText(text)) << text;
  // Control characters, then invalid UTF-8: truncated and overlong sequences, a surrogate, a code
  // point above U+10FFFF, a lone continuation byte.
  for (const char* none : {"\n", "\x1b", "\x7f", "\xc2\x9b", "\xc3", "\xe2\x84", "\xe2\x84x",
                           "\xc1\xbf", "\xe0\x9f\xbf", "\xf0\x8f\xbf\xbf", "\xed\xa0\x80",
                           "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\x80"})
    EXPECT_FALSE(isText(none)) << printable(none);
}

TEST(Text, EndsWithAWholeCharacter) {
  EXPECT_EQ(wholeCharacters("a\xc2\xb5"), "a\xc2\xb5");
  EXPECT_EQ(wholeCharacters("a\xc2"), "a");
  EXPECT_EQ(wholeCharacters("\xf0\x9f\xa6"), "");
  EXPECT_EQ(wholeCharacters("a\nb\xe2\x82"), "a\nb") << "lines of a program's output";
  EXPECT_EQ(wholeCharacters("a\xff\xff\xff\xff"), "a\xff\xff\xff\xff") << "is none";
}

TEST(Text, ShowsWhatATerminalWouldFollow) {
  EXPECT_EQ(printable("a\tb\n\xc2\xb5"), "a\tb\n\xc2\xb5");
  EXPECT_EQ(printable("\x1b[31m\xffz\xc2\x9b"), "\\x1b[31m\\xffz\\xc2\\x9b");
}

TEST(Nearest, FindsTypingErrorsAndNothingFarAway) {
  const std::vector<std::string> known = {"port", "baud", "rate_hz", "model_radius_m"};
  EXPECT_EQ(nearestWord("prot", known), "port");
  EXPECT_EQ(nearestWord("rate_Hz", known), "rate_hz");
  EXPECT_EQ(nearestWord("model_radius", known), "model_radius_m");
  EXPECT_EQ(nearestWord("thermal", known), "");
  EXPECT_EQ(nearestWord(std::string(100'000, 'x'), known), "");
}

TEST(FileCopy, IsTheFilesBytesAndStaysThemWhateverBecomesOfTheFile) {
  const test::TempDir dir;
  test::writeText(dir / "f", std::string(10'000, 'a'));
  const auto copy = FileCopy::read(dir / "f");
  ASSERT_TRUE(copy);
  EXPECT_EQ(copy->stamp(), fileStamp(dir / "f"));
  test::writeText(dir / "f", std::string(10'000, 'b'));  // overwrites the file in place
  EXPECT_NE(copy->stamp(), fileStamp(dir / "f"));
  ASSERT_EQ(::truncate((dir / "f").c_str(), 0), 0);
  EXPECT_EQ(copy->text(), std::string(10'000, 'a'));
  EXPECT_EQ(FileCopy::read(dir / "f")->text(), "");
  test::writeText(dir / "f", "abc");
  EXPECT_EQ(FileCopy::read(dir / "f", 2)->text(), "ab");
}

TEST(FileCopy, WhatCannotBeReadIsAnError) {
  const test::TempDir dir;
  EXPECT_EQ(FileCopy::read(dir / "none").error().code, Errc::kNotFound);
  EXPECT_EQ(FileCopy::read(dir.path()).error().code, Errc::kMalformed);
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(FileCopy::read(dir / "pipe").error().code, Errc::kMalformed) << "and does not wait";
  EXPECT_FALSE(fileStamp(dir / "pipe"));
  test::writeText(dir / "vast", "");
  // A sparse file: 4 TiB without blocks on the disk.
  ASSERT_EQ(::truncate((dir / "vast").c_str(), off_t{1} << 42), 0);
  const auto vast = FileCopy::read(dir / "vast");
  ASSERT_FALSE(vast);
  EXPECT_EQ(vast.error().code, Errc::kIo);
  EXPECT_NE(vast.error().what.find("do not fit into this machine's memory"), std::string::npos);
  EXPECT_TRUE(FileCopy::read(dir / "vast", 100)) << "its beginning does";
}

TEST(MappedFile, IsTheFilesBytes) {
  const test::TempDir dir;
  test::writeText(dir / "f", "abc");
  test::writeText(dir / "empty", "");
  EXPECT_EQ(MappedFile::open(dir / "f")->text(), "abc");
  EXPECT_EQ(MappedFile::open(dir / "empty")->text(), "");
  EXPECT_EQ(MappedFile::open(dir / "none").error().code, Errc::kNotFound);
  EXPECT_EQ(MappedFile::open(dir.path()).error().code, Errc::kMalformed);
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(MappedFile::open(dir / "pipe").error().code, Errc::kMalformed) << "and does not wait";
  MappedFile moved = *MappedFile::open(dir / "f");
  moved = *MappedFile::open(dir / "empty");
  EXPECT_EQ(moved.text(), "");
}

#if !defined(MERLIN_ANY_SANITIZER)  // which need terabytes
TEST(MappedFile, AFileThatIsLargerThanTheAllowedMemoryIsAnErrorOfItsOwn) {
  const test::TempDir dir;
  test::writeText(dir / "vast", "");
  // A sparse file: 4 TiB without blocks on the disk.
  ASSERT_EQ(::truncate((dir / "vast").c_str(), off_t{1} << 42), 0);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_AS, &before), 0);
  const rlimit less{std::min(rlim_t{1} << 41, before.rlim_cur), before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_AS, &less), 0);
  const auto vast = MappedFile::open(dir / "vast");
  ASSERT_EQ(::setrlimit(RLIMIT_AS, &before), 0);
  ASSERT_FALSE(vast);
  EXPECT_EQ(vast.error().code, Errc::kNoMemory);
  EXPECT_NE(vast.error().what.find("vast: its 4398046511104 bytes take more memory than this "
                                   "program may use (a limit such as ulimit -v)"),
            std::string::npos)
      << vast.error().what;
}
#endif

TEST(MappedFile, ItsTextBeginsBehindAByteOrderMark) {
  const test::TempDir dir;
  const std::string mark = "\xEF\xBB\xBF";
  test::writeText(dir / "a", mark + "abc");
  EXPECT_EQ(MappedFile::open(dir / "a")->text(), "abc");
  EXPECT_EQ(MappedFile::open(dir / "a")->bytes().size(), 6u) << "the bytes are the file's";
  test::writeText(dir / "b", mark);
  EXPECT_EQ(MappedFile::open(dir / "b")->text(), "");
  test::writeText(dir / "c", mark.substr(0, 2));
  EXPECT_EQ(MappedFile::open(dir / "c")->text(), mark.substr(0, 2)) << "cut";
}

TEST(WriteFile, AFileAppearsWholeOrTheOldOneStays) {
  const test::TempDir dir;
  ASSERT_TRUE(writeFile(dir / "f", "old"));
  EXPECT_FALSE(writeFile(dir / "f", [](const WriteBytes& write) {
    return write(std::as_bytes(std::span("half"))) && false;
  }));
  EXPECT_EQ(test::readText(dir / "f"), "old");
  ASSERT_TRUE(writeFile(dir / "f", std::string(3 << 20, 'x')));
  EXPECT_EQ(test::readText(dir / "f"), std::string(3 << 20, 'x'));
  EXPECT_EQ(writeFile(dir / "none/f", "x").error().code, Errc::kNotFound);
  std::string head = "?";
  ASSERT_TRUE(writeFileHeadLast(
      dir / "f", 4,
      [&](const WriteBytes& write) {
        head = "head";
        return write(std::as_bytes(std::span("body", 4)));
      },
      [&] { return std::as_bytes(std::span(head)); }));
  EXPECT_EQ(test::readText(dir / "f"), "headbody");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1)
      << "no temporary file is left";
}

// Simulates a full disk by limiting the size of a file to 1 kB.
TEST(WriteFile, OnAFullDiskTheOldOneStays) {
  const test::TempDir dir;
  ASSERT_TRUE(writeFile(dir / "f", "old"));
  ASSERT_NE(::signal(SIGXFSZ, SIG_IGN), SIG_ERR);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit little{1000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &little), 0);
  const auto written = writeFile(dir / "f", std::string(5000, 'x'));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::kIo);
  EXPECT_EQ(test::readText(dir / "f"), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1);
}

TEST(WriteFile, ReplacesNothingButFiles) {
  const test::TempDir dir;
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(writeFile(dir / "pipe", "x").error().code, Errc::kIo);
  EXPECT_EQ(checkWritable(dir / "pipe").error().code, Errc::kIo);
  EXPECT_TRUE(std::filesystem::is_fifo(dir / "pipe"));
}

TEST(CheckWritable, SaysBeforeTheWorkThatItWouldBeInVain) {
  const test::TempDir dir;
  EXPECT_TRUE(checkWritable(dir / "new"));
  EXPECT_TRUE(checkWritable("new-in-this-folder"));
  EXPECT_EQ(checkWritable(dir / "none/new").error().code, Errc::kNotFound);
  EXPECT_EQ(checkWritable(dir.path()).error().code, Errc::kIo) << "is a folder";
}

TEST(Random, IsTheSameEverywhere) {
  Random random(42);
  EXPECT_EQ(random.next(), 13679457532755275413ULL);
  EXPECT_EQ(random.next(), 2949826092126892291ULL);
  for (int i = 0; i < 1000; ++i) {
    const double u = random.uniform(-2, 3);
    EXPECT_TRUE(u >= -2 && u < 3);
    EXPECT_LT(random.below(7), 7u);
  }
}

TEST(Random, NormalHasMeanZeroAndDeviationOne) {
  Random random(1);
  double sum = 0, squares = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double x = random.normal();
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / 100'000, 0, 0.01);
  EXPECT_NEAR(squares / 100'000, 1, 0.02);
}

TEST(DatedFiles, AreNamedByTimeAndTheOldestGo) {
  const test::TempDir dir;
  const DatedFiles files(dir / "f", "lab-ball", ".bytes", 3);
  constexpr std::time_t kThen = 1'795'410'000;  // 2026-11-23 05:00:00 UTC
  std::vector<std::string> made;
  for (const std::time_t at : {kThen + 1, kThen, kThen, kThen + 2, kThen}) {
    const auto path = files.next(at);
    ASSERT_TRUE(path) << path.error().what;
    ASSERT_TRUE(writeFile(*path, "x"));
    made.push_back(*path);
  }
  const std::string start = dir / "f/lab-ball-20261123T05000";
  EXPECT_EQ(made,
            (std::vector<std::string>{start + "1Z.bytes", start + "0Z.bytes", start + "0Z-2.bytes",
                                      start + "2Z.bytes", start + "0Z-3.bytes"}));
  const std::vector<std::string> others = {start + "0Z.txt", start + "0Z-x.bytes",
                                           dir / "f/lab-ball-mine.bytes",
                                           dir / "f/lab-ball-2-20261123T050000Z.bytes"};
  for (const std::string& other : others) ASSERT_TRUE(writeFile(other, "x"));
  files.removeOldest(kThen + 2);
  for (const std::string& other : others) EXPECT_TRUE(std::filesystem::exists(other)) << other;
  const auto stays = [](const std::string& path) { return std::filesystem::exists(path); };
  EXPECT_FALSE(stays(made[1]) || stays(made[2])) << "the oldest two";
  EXPECT_TRUE(stays(made[0]) && stays(made[3]) && stays(made[4]));
  files.removeOldest(kThen);
  ASSERT_TRUE(writeFile(*files.next(kThen), "x"));
  files.removeOldest(kThen);
  EXPECT_TRUE(stays(start + "0Z.bytes")) << "the newest by a clock that was set back";
  EXPECT_TRUE(stays(made[4]));
  EXPECT_FALSE(stays(made[0])) << "of the future";
}

TEST(Bytes, InTheirStatedOrder) {
  const std::uint8_t b[] = {0x01, 0x02, 0x03, 0x84};
  EXPECT_EQ(loadBe16(b), 0x0102);
  EXPECT_EQ(loadLe32(b), 0x84030201u);
  std::string out;
  appendBe16(out, 0xABCD);
  appendLe32(out, 0x12345678);
  appendLeFloat(out, 1.0F);
  EXPECT_EQ(out, std::string("\xAB\xCD\x78\x56\x34\x12\x00\x00\x80\x3F", 10));
}

TEST(SystemClock, SleepsUntilThenAndWakesForAStop) {
  SystemClock clock;
  const Timestamp then = clock.now() + std::chrono::milliseconds(5);
  EXPECT_TRUE(clock.sleepUntil(then, {}));
  EXPECT_GE(clock.now(), then);
  std::stop_source stop;
  std::jthread stopper([&] { stop.request_stop(); });
  EXPECT_FALSE(clock.sleepUntil(clock.now() + std::chrono::hours(1), stop.get_token()));
}

TEST(ChildWork, HandsOverItsResultOrItsError) {
  using std::chrono::seconds;
  const std::string large(1'000'000, 'x');
  EXPECT_EQ(*inChild([&]() -> Result<std::string> { return large; }, "ended", seconds(10)), large);
  const auto failed = inChild(
      []() -> Result<std::string> {
        return Error{Errc::kUnsupported, "why"};
      },
      "ended", seconds(10));
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().code, Errc::kUnsupported);
  EXPECT_EQ(failed.error().what, "why");
}

TEST(ChildWork, AnEndOfTheChildIsAnError) {
  const auto aborted = inChild([]() -> Result<std::string> { std::abort(); }, "is damaged",
                               std::chrono::seconds(10));
  ASSERT_FALSE(aborted);
  EXPECT_EQ(aborted.error().code, Errc::kMalformed);
  EXPECT_EQ(aborted.error().what, "is damaged");
  const auto endless = inChild(
      []() -> Result<std::string> {
        const std::atomic<bool> on{true};
        while (on) {
        }
        return std::string();
      },
      "takes too long", std::chrono::seconds(1));
  ASSERT_FALSE(endless);
  EXPECT_EQ(endless.error().what, "takes too long");
}

// That all nodes of one GPU have one folder is tested in the virtual machine, which has a GPU.
TEST(DeviceFolderTest, WhatBelongsToNoDeviceHasNone) {
  EXPECT_EQ(deviceFolder("/dev/null"), "") << "memory, not a device";
  EXPECT_EQ(deviceFolder("/dev/dri/no such card"), "");
  EXPECT_EQ(deviceFolder("/etc/passwd"), "") << "not a device node";
  EXPECT_EQ(deviceFolder(""), "");
}

}  // namespace
}  // namespace merlin
