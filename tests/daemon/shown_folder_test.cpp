// The content folder: which files merlind opens and removes there, and which files merlin show
// writes there.
#include "daemon/wall/shown_folder.h"

#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "daemon/base/open_below.h"
#include "daemon/cli/show/content_folder.h"
#include "daemon/cli/show/file_kind.h"
#include "daemon/wall/notice.h"
#include "tests/support/fake_clock.h"
#include "tests/support/pyramids.h"
#include "tests/support/temp_dir.h"

namespace merlin::wall {
namespace {

namespace fs = std::filesystem;
using std::chrono::minutes;
using std::chrono::seconds;
using Names = std::vector<std::string>;

TEST(Surplus, TheNewestStayUntilTheyTakeHalf) {
  const std::vector<FolderFile> files = {{"old.mrm", 10, seconds(30)},
                                         {"new.mrm", 20, seconds(10)},
                                         {"middle.mrm", 25, seconds(20)},
                                         {"shown.mrm", 5, seconds(99)}};
  const Names kept = {"shown.mrm"};
  EXPECT_EQ(surplusOf(files, kept, 100), (Names{"old.mrm"})) << "5 + 20 + 25 are half";
  EXPECT_EQ(surplusOf(files, kept, 98), (Names{"middle.mrm"})) << "an older one fits yet";
  EXPECT_EQ(surplusOf(files, kept, 120), Names{});
}

TEST(Surplus, WhatIsShownStaysHoweverLargeAndLeavesNoRoomForOthers) {
  const std::vector<FolderFile> files = {
      {"large.mrm", 90, seconds(50)}, {"a.mrm", 1, seconds(1)}, {"empty.mrm", 0, seconds(2)}};
  EXPECT_EQ(surplusOf(files, Names{"large.mrm", ""}, 100), (Names{"a.mrm", "empty.mrm"}));
  EXPECT_EQ(surplusOf(files, Names{"gone.mrm"}, 2), (Names{"large.mrm"}));
}

TEST(Surplus, WhatIsBeingWrittenIsNoneAndIsLeftOverAfterAnHour) {
  const std::vector<FolderFile> files = {{".a", 900, minutes(61)},
                                         {".b", 900, minutes(60)},
                                         {"c.mrm", 1, minutes(600)},
                                         {".d", 0, seconds(-5)}};
  EXPECT_EQ(surplusOf(files, {}, 2), Names{}) << "they do not count";
  EXPECT_EQ(leftOversOf(files), (Names{".a"}));
}

class Folder : public testing::Test {
 protected:
  Folder() { EXPECT_TRUE(folder_.make()); }
  std::string in(const std::string& name) const { return folder_.path() + "/" + name; }
  void put(const std::string& name, int age_s = 0) const {
    test::writeText(in(name), test::pyramidBytes({.width = 8, .height = 8}));
    fs::last_write_time(in(name), fs::file_time_type::clock::now() - seconds(age_s));
  }
  std::string fault(const std::string& name) const {
    const auto entry = folder_.entryOf(name);
    return entry ? "" : entry.error().what;
  }
  std::string whyUnread(const ContentEntry& entry) const {
    std::vector<std::string> skipped;
    const auto read = readContent(entry, {}, {}, skipped);
    return read ? "" : read.error().what;
  }
  void expectFault(const std::string& name, const std::string& part) const {
    EXPECT_NE(fault(name).find(part), std::string::npos) << name << ": " << fault(name);
  }

  test::TempDir dir_;
  ShownFolder folder_{ShownSettings{dir_ / "a/b.shown", 1}};
};

TEST_F(Folder, IsMadeForItsGroup) {
  EXPECT_EQ(folder_.fault(), "");
  struct stat status {};
  ASSERT_EQ(::stat(folder_.path().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 02770U);
  EXPECT_TRUE(ShownFolder(ShownSettings{folder_.path(), 1}).make()) << "it is there already";
}

TEST_F(Folder, OneThatCannotBeMadeIsSaidAndNothingIsShown) {
  test::writeText(dir_ / "file", "");
  ShownFolder none{ShownSettings{dir_ / "file/shown", 1}}, unset{ShownSettings{}};
  const auto made = none.make();
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().what.find("file/shown: "), std::string::npos) << made.error().what;
  EXPECT_EQ(none.fault(), made.error().what);
  EXPECT_FALSE(unset.make());
  EXPECT_EQ(unset.entryOf("a.tif").error().code, Errc::kUnsupported);
}

TEST_F(Folder, WhatTheConfigurationNamesIsNeverRemoved) {
  fs::create_directory(in("talk"));
  put("talk/1.tif");
  put("kept.tif");
  put("old.tif");
  const ShownSettings settings{folder_.path(), 0};
  ShownFolder folder(settings,
                     {in("kept.tif"), folder_.path() + "/../b.shown/talk", dir_ / "else"});
  EXPECT_TRUE(folder.tidy("new.tif").empty());
  EXPECT_TRUE(fs::exists(in("kept.tif")) && fs::exists(in("talk/1.tif")));
  EXPECT_FALSE(fs::exists(in("old.tif")));
}

TEST_F(Folder, AFileIsAContentByItsNameAndItsEnding) {
  put("photo 1.tif");
  const auto picture = folder_.entryOf("photo 1.tif");
  ASSERT_TRUE(picture) << picture.error().what;
  EXPECT_EQ(picture->name, "photo 1");
  EXPECT_EQ(picture->kind, ContentKind::kPicture);
  EXPECT_EQ(whyUnread(*picture), "");
  fs::create_directory(in("talk"));
  put("talk/1.tif");
  const auto slides = folder_.entryOf("talk");
  ASSERT_TRUE(slides);
  EXPECT_EQ(slides->kind, ContentKind::kSlides);
  EXPECT_EQ(whyUnread(*slides), "");
}

// If two contents have the same name, the newer one counts. Files that are not contents have no
// name.
TEST_F(Folder, WhatCanBeShownAgainHasANameTheNewestFirst) {
  put("photo 1.tif", 30);
  put("scan.mrm", 20);
  put("scan.tif", 40);
  fs::create_directory(in("talk"));
  put(".half.tif");
  put("notes.txt");
  fs::create_symlink(in("scan.mrm"), in("link.mrm"));
  std::vector<std::string> named;
  for (const NamedFile& file : folder_.namedFiles()) named.push_back(file.name + "=" + file.file);
  EXPECT_EQ(named, (std::vector<std::string>{"talk=talk", "scan=scan.mrm", "photo 1=photo 1.tif"}));
}

TEST_F(Folder, NoPathIsOpened) {
  put("a.tif");
  test::writeText(dir_ / "a/secret.tif", test::pyramidBytes());
  for (const std::string& name :
       {in("a.tif"), std::string("../secret.tif"), std::string("./a.tif"), std::string(".a.tif"),
        std::string(".."), std::string(), std::string("a.tif/"), std::string("a\n.tif")})
    expectFault(name, "is not the name of a file in the content folder " + folder_.path());
  expectFault(std::string(201, 'a'), "is not the name of a file");
  expectFault("absent.mrm", "absent.mrm: No such file or directory");
  put("a.txt");
  expectFault("a.txt", "is neither a model (.mrm), a pyramid (.tif)");
}

TEST_F(Folder, NoLinkIsFollowed) {
  test::writeText(dir_ / "secret.tif", test::pyramidBytes());
  fs::create_directory(dir_ / "secrets");
  test::writeText(dir_ / "secrets/1.tif", test::pyramidBytes());
  fs::create_symlink(dir_ / "secret.tif", in("link.tif"));
  expectFault("link.tif", "link.tif: is a link, and links are not followed here");
  fs::create_directory_symlink(dir_ / "secrets", in("links"));
  expectFault("links", "links: is a link");
  fs::create_directory(in("talk"));
  fs::create_symlink(dir_ / "secret.tif", in("talk/1.tif"));
  const auto talk = folder_.entryOf("talk");
  ASSERT_TRUE(talk);
  EXPECT_NE(whyUnread(*talk).find("1.tif: is a link"), std::string::npos) << whyUnread(*talk);
}

// Somebody replaces a file by a link after merlind has examined the file.
TEST_F(Folder, NorOneThatComesBetweenLookingAndReading) {
  test::writeText(dir_ / "secret.tif", test::pyramidBytes());
  put("photo.tif");
  fs::create_directory(in("talk"));
  put("talk/1.tif");
  const auto photo = folder_.entryOf("photo.tif"), talk = folder_.entryOf("talk");
  ASSERT_TRUE(photo && talk);
  fs::remove(in("photo.tif"));
  fs::create_symlink(dir_ / "secret.tif", in("photo.tif"));
  fs::rename(in("talk"), dir_ / "talk");
  fs::create_directory_symlink(dir_ / "talk", in("talk"));
  EXPECT_NE(whyUnread(*photo).find("is a link"), std::string::npos) << whyUnread(*photo);
  EXPECT_NE(whyUnread(*talk).find("is not a folder (links are not followed"), std::string::npos)
      << whyUnread(*talk);
}

TEST_F(Folder, WhatIsNoFileBlocksNobody) {
  ASSERT_EQ(::mkfifo(in("pipe.tif").c_str(), 0600), 0);
  expectFault("pipe.tif", "pipe.tif: is not a regular file");
  const int made = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const UniqueFd socket(made);
  sockaddr_un address{AF_UNIX, {}};
  in("s.mrm").copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(made, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  expectFault("s.mrm", "s.mrm: is not a regular file");
}

TEST_F(Folder, OneThatIsTooLargeIsRefused) {
  put("a.tif");
  fs::resize_file(in("a.tif"), 1'000'000);
  EXPECT_EQ(fault("a.tif"), "");
  fs::resize_file(in("a.tif"), 1'000'001);
  expectFault("a.tif", "has 1000001 bytes; /wall/shown/limit_mb allows 1 MB");
}

TEST_F(Folder, OldOnesGoButNotTheOneBefore) {
  for (const char* const name : {"a.tif", "b.tif", "c.tif"}) put(name, 100);
  for (const char* const name : {"a.tif", "b.tif", "c.tif"}) fs::resize_file(in(name), 400'000);
  const auto there = [&] {
    Names names;
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
  };
  EXPECT_TRUE(folder_.tidy("a.tif").empty());
  EXPECT_EQ(there(), (Names{"a.tif"})) << "another one does not fit into 500,000 bytes";
  put("b.tif");
  fs::resize_file(in("b.tif"), 400'000);
  EXPECT_TRUE(folder_.tidy("b.tif").empty());
  EXPECT_EQ(there(), (Names{"a.tif", "b.tif"}));
  put("c.tif");
  EXPECT_TRUE(folder_.tidy("c.tif").empty());
  EXPECT_EQ(there(), (Names{"b.tif", "c.tif"}));
}

TEST_F(Folder, LeftOversGoAtTheStart) {
  fs::create_directory(in(".merlin-import-old"));
  put(".merlin-import-old/half.mrm");
  fs::last_write_time(in(".merlin-import-old"), fs::file_time_type::clock::now() - minutes(61));
  put(".fresh");
  put("a.tif", 7200);
  EXPECT_TRUE(ShownFolder(ShownSettings{folder_.path(), 1}).make());
  EXPECT_FALSE(fs::exists(in(".merlin-import-old")));
  EXPECT_TRUE(fs::exists(in(".fresh")));
  EXPECT_TRUE(fs::exists(in("a.tif")));
}

TEST(NoticeTest, LastsFiveSecondsInSharedMemory) {
  test::FakeClock clock;
  shm::SeqSlot<shm::WallNotice> slot;
  const render::tiles::TilePlan nothing{};
  Notice notice(nothing, slot, clock);
  const auto text = [&] {
    notice.tend(clock.now());
    const auto read = slot.read();
    return read ? std::string(read->text) : "unset";
  };
  EXPECT_EQ(text(), "unset");
  ASSERT_TRUE(notice.show("Reading scan.pgm: 45 %"));
  EXPECT_EQ(text(), "Reading scan.pgm: 45 %");
  clock.advance(std::chrono::milliseconds(4999));
  EXPECT_EQ(text(), "Reading scan.pgm: 45 %");
  clock.advance(std::chrono::milliseconds(1));
  EXPECT_EQ(text(), "");
  ASSERT_TRUE(notice.show("again"));
  ASSERT_TRUE(notice.show("off"));
  EXPECT_EQ(text(), "");
  EXPECT_TRUE(notice.show(std::string(151, 'a')));
  for (const std::string& bad :
       {std::string(152, 'a'), std::string(), std::string("a\nb"), std::string("\xFF")})
    EXPECT_FALSE(notice.show(bad)) << bad;
}

}  // namespace
}  // namespace merlin::wall

namespace merlin::cli {
namespace {

TEST(FileKinds, APgmIsRangesIfItsHeaderSaysHow) {
  EXPECT_FALSE(saysGeometry("P5\n4 4\n255\n"));
  EXPECT_FALSE(saysGeometry("P5\n# made by hand\n4 4\n255\n# geometry: pinhole\n"));
  EXPECT_TRUE(saysGeometry("P5\n# made by hand\n# geometry: pinhole\n4 4\n255\n"));
  EXPECT_TRUE(saysGeometry("P2\n# angles: 60 45\n4 4\n255\n"));
  EXPECT_TRUE(saysGeometry("P5\n# geometry: round\n4 4\n255\n"))
      << "mesh import says what is wrong";
  EXPECT_FALSE(saysGeometry("P5\n#"));
}

TEST(FileKinds, AFitsImageIsRangesIfACardSaysHow) {
  const auto header = [](const std::vector<std::string>& cards) {
    std::string text;
    for (const std::string& card : cards) text += fmt::format("{:80}", card);
    return text;
  };
  EXPECT_FALSE(saysGeometry(header({"SIMPLE  = T", "NAXIS   = 2", "END", "GEOMETRY= 'pinhole'"})));
  EXPECT_TRUE(saysGeometry(header({"SIMPLE  = T", "GEOMETRY= 'pinhole'", "END"})));
  EXPECT_TRUE(saysGeometry(header({"SIMPLE  = T", "CELLX   = 30", "END"})));
}

// Returns a TIFF with these tags only, in either byte order.
std::string tiff(bool little, const std::vector<std::pair<int, int>>& tags) {
  std::string bytes = little ? std::string("II*\0", 4) : std::string("MM\0*", 4);
  const auto put = [&](int value, int size) {
    for (int i = 0; i < size; ++i)
      bytes += static_cast<char>(value >> 8 * (little ? i : size - 1 - i) & 255);
  };
  put(8, 4);
  put(static_cast<int>(tags.size()), 2);
  for (const auto& [tag, value] : tags) {
    put(tag, 2);
    put(3, 2);
    put(1, 4);
    put(value, 2);
    put(0, 2);
  }
  return bytes;
}

TEST(FileKinds, ATiffIsAMapIfItHasGeoKeysAndOneValuePerPixel) {
  for (const bool little : {true, false}) {
    EXPECT_TRUE(saysGeometry(tiff(little, {{277, 1}, {34735, 9}})));
    EXPECT_TRUE(saysGeometry(tiff(little, {{34735, 9}})));
    EXPECT_FALSE(saysGeometry(tiff(little, {{277, 3}, {34735, 9}}))) << "a picture from the air";
    EXPECT_FALSE(saysGeometry(tiff(little, {{277, 1}})));
  }
  const std::string whole = tiff(true, {{277, 1}, {34735, 9}});
  for (std::size_t n = 0; n < 22; ++n) EXPECT_FALSE(saysGeometry(whole.substr(0, n))) << n;
}

TEST(FileKinds, TheNameIsTheFilesWithTheEndingOfWhatIsMade) {
  EXPECT_EQ(*nameInFolder("a/scan.pgm", FileKind::kMesh), "scan.mrm");
  EXPECT_EQ(*nameInFolder("photo.v2.jpg", FileKind::kPicture), "photo.v2.tif");
  EXPECT_EQ(*nameInFolder("a/talk.2026/", FileKind::kSlides), "talk.2026");
  EXPECT_FALSE(nameInFolder("a\nb.mrm", FileKind::kModel));
  EXPECT_FALSE(nameInFolder(".hidden.jpg", FileKind::kPicture));
  EXPECT_FALSE(nameInFolder(std::string(197, 'a') + ".ply", FileKind::kMesh));
}

TEST(Putting, ReplacesAFolderAndLeavesTheOldOneInTheWorkFolder) {
  namespace fs = std::filesystem;
  const test::TempDir dir;
  const ContentFolder folder{dir / "shown", 1000};
  fs::create_directories(folder.path + "/.work/talk");
  fs::create_directories(folder.path + "/talk");
  test::writeText(folder.path + "/talk/old.tif", "old");
  test::writeText(folder.path + "/.work/talk/new.tif", "new");
  ASSERT_TRUE(handOver(folder.path + "/.work/talk", folder, "talk"));
  EXPECT_FALSE(fs::exists(folder.path + "/talk/old.tif"));
  EXPECT_EQ(test::readText(folder.path + "/talk/new.tif"), "new");
  EXPECT_EQ(fs::status(folder.path + "/talk/new.tif").permissions(), fs::perms(0640));
  EXPECT_EQ(fs::status(folder.path + "/talk").permissions(), fs::perms(0770));
  EXPECT_EQ(*roomIn(folder), 994U) << "3 bytes each, in the work folder as well";
  EXPECT_EQ(roomIn({folder.path, 6}).error().code, Errc::kUnsupported);
}

TEST(Putting, WhoMayNotWriteIsToldTheGroupAndHowToJoinIt) {
  namespace fs = std::filesystem;
  const test::TempDir dir;
  fs::permissions(dir.path(), fs::perms(0755));
  fs::create_directory(dir / "shown");
  fs::permissions(dir / "shown", fs::perms(0500));
  // Root may write everywhere, so the test continues as another user.
  const uid_t before = ::geteuid();
  if (before == 0) {
    ASSERT_EQ(::seteuid(65534), 0);
  }
  const auto room = roomIn({dir / "shown", 1000});
  ASSERT_EQ(::seteuid(before), 0);
  ASSERT_FALSE(room);
  const std::string& what = room.error().what;
  EXPECT_NE(what.find(dir / "shown" + ": user "), std::string::npos) << what;
  EXPECT_NE(what.find("join it (sudo usermod -aG "), std::string::npos) << what;
}

TEST(Putting, ACopyIsWholeAndTheProgressEndsAtOne) {
  const test::TempDir dir;
  test::writeText(dir / "a", std::string(3'000'000, 'x'));
  double last = 1;
  ASSERT_TRUE(copyFile(dir / "a", dir / "b", [&](double share) { last = share; }));
  EXPECT_EQ(test::readText(dir / "b"), std::string(3'000'000, 'x'));
  EXPECT_EQ(last, 1.0);
  EXPECT_FALSE(copyFile(dir / "a", dir / "b", {})) << "it is there";
  EXPECT_EQ(copyFile(dir / "none", dir / "c", {}).error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace merlin::cli
