// .mrm files that are truncated, damaged, of a later version, or malicious are refused. The message
// names the file and the section.
#include <functional>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/render/mrm_files.h"

namespace merlin::render {
namespace {

using lod::mrm::Kind;
using test::MrmBytes;

class MrmDamage : public testing::Test {
 protected:
  Result<lod::Dendrogram> read(const std::string& bytes) const {
    test::writeText(path_, bytes);
    return lod::readMrm(path_);
  }
  // Returns the error message for these bytes, without the file's name, with which the message must
  // begin.
  std::string faultOf(const std::string& bytes, Errc code = Errc::kMalformed) const {
    const auto result = read(bytes);
    if (result) return "none";
    const std::string& what = result.error().what;
    EXPECT_EQ(result.error().code, code) << what;
    EXPECT_TRUE(what.starts_with(path_ + ": ")) << what;
    return what.substr(std::min(what.size(), path_.size() + 2));
  }
  // Returns the error message after `change` was made to one entry of the table and the checksums
  // were corrected.
  std::string faultWith(Kind kind, const std::function<void(MrmBytes::Entry&)>& change,
                        Errc code = Errc::kMalformed) const {
    MrmBytes file = golden_;
    MrmBytes::Entry entry = file.entry(file.find(kind));
    change(entry);
    file.set(file.find(kind), entry);
    return faultOf(file.seal().bytes, code);
  }
  std::string faultWith(const std::function<void(MrmBytes::Header&)>& change,
                        Errc code = Errc::kMalformed) const {
    MrmBytes file = golden_;
    MrmBytes::Header header = file.header();
    change(header);
    file.set(header);
    return faultOf(file.seal().bytes, code);
  }

  const test::TempDir dir_;
  const std::string path_ = dir_ / "cube.mrm";
  const MrmBytes golden_{test::readText(test::kGoldenCube)};
};

TEST_F(MrmDamage, SealingChangesNothingInASoundFile) {
  MrmBytes file = golden_;
  EXPECT_EQ(file.seal().bytes, golden_.bytes);
  EXPECT_EQ(faultOf(golden_.bytes), "none");
}

TEST_F(MrmDamage, EveryPrefixIsRefused) {
  for (std::size_t size = 0; size < golden_.bytes.size(); ++size) {
    const std::string fault = faultOf(golden_.bytes.substr(0, size));
    ASSERT_NE(fault, "none") << size;
    if (size < sizeof(lod::mrm::FileHeader)) {
      ASSERT_EQ(fault, "is too short for an .mrm file") << size;
    } else {
      ASSERT_EQ(fault, "has " + std::to_string(size) +
                           " bytes, its header says 1384: cut short or overwritten");
    }
  }
  EXPECT_NE(faultOf(golden_.bytes + '\0'), "none");
}

// Inverts each single bit and each whole byte of the file in turn.
TEST_F(MrmDamage, EveryDamagedByteIsFoundUnlessItBelongsToNothing) {
  test::writeText(path_, golden_.bytes);
  const int file = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
  std::size_t padding = 0;
  for (std::size_t i = 0; i < golden_.bytes.size(); ++i) {
    const bool is_padding = golden_.isPadding(i);
    if (is_padding) ++padding;
    for (const int flip : {1, 2, 4, 8, 16, 32, 64, 128, 255}) {
      const auto damaged = static_cast<char>(golden_.bytes[i] ^ flip);
      ASSERT_EQ(::pwrite(file, &damaged, 1, static_cast<off_t>(i)), 1);
      const auto result = lod::readMrm(path_);
      ASSERT_EQ(result.ok(), is_padding) << "byte " << i << ", bits " << flip;
      if (result) test::expectSame(*result, test::goldenCube());
      ASSERT_TRUE(result || result.error().what.starts_with(path_ + ": ")) << i;
    }
    ASSERT_EQ(::pwrite(file, &golden_.bytes[i], 1, static_cast<off_t>(i)), 1);
  }
  ::close(file);
  EXPECT_EQ(padding, 256u);
}

TEST_F(MrmDamage, SaysWhatIsDamaged) {
  for (const auto& [kind, message] : {std::pair(Kind::kPositions, "section positions is damaged"),
                                      {Kind::kFeature, "section feature is damaged"},
                                      {Kind::kParents, "section parents is damaged"},
                                      {Kind::kTriangles, "section triangles is damaged"},
                                      {Kind::kAlive, "section alive is damaged"},
                                      {Kind::kError, "section error is damaged"},
                                      {Kind::kAbout, "section about is damaged"}}) {
    MrmBytes file = golden_;
    file.put(kind, 0, std::uint8_t{0xA5});
    EXPECT_EQ(faultOf(file.bytes), message);
  }
  MrmBytes file = golden_;
  file.bytes[20] ^= 1;
  EXPECT_EQ(faultOf(file.bytes), "the header is damaged");
  file = golden_;
  file.bytes[MrmBytes::entryAt(2)] ^= 1;
  EXPECT_EQ(faultOf(file.bytes), "the section table is damaged");
}

TEST_F(MrmDamage, AnotherKindOfFileIsToldFromADamagedOne) {
  const std::string ply = "ply\nformat ascii 1.0\n" + std::string(200, ' ');
  EXPECT_EQ(faultOf(ply), "is not an .mrm file (make one with: merlin mesh reduce IN -o OUT.mrm)");
}

// The version is checked first, since a later version may have another header.
TEST_F(MrmDamage, AnotherVersionIsNotSupported) {
  for (const unsigned version : {0U, 2U, 0xFFFFFFFFU}) {
    const std::string fault = "is version " + std::to_string(version) +
                              " of .mrm, but this program reads version 1; make it again with: "
                              "merlin mesh reduce";
    const auto change = [&](MrmBytes::Header& h) { h.version = version; };
    EXPECT_EQ(faultWith(change, Errc::kUnsupported), fault);
    MrmBytes file = golden_;
    MrmBytes::Header header = file.header();
    header.version = version;
    file.set(header);
    EXPECT_EQ(faultOf(file.bytes, Errc::kUnsupported), fault) << "checksums of another kind";
  }
}

// Turns the golden file's last feature into a section of an unknown kind.
TEST_F(MrmDamage, AnUnknownSectionIsSkippedFrom1000OnAndRefusedBelow) {
  for (const unsigned kind : {0U, 8U, 999U}) {
    const auto change = [&](MrmBytes::Entry& e) { e.kind = kind; };
    EXPECT_EQ(faultWith(Kind::kFeature, change, Errc::kUnsupported),
              "section kind " + std::to_string(kind) + " is not known");
  }
  for (const unsigned kind : {1001U, 1002U, 0xFFFFFFFFU}) {
    MrmBytes file = golden_;
    MrmBytes::Entry entry = file.entry(6);
    ASSERT_EQ(entry.kind, 2u);
    entry.kind = kind;
    file.set(6, entry);
    const auto result = read(file.seal().bytes);
    ASSERT_TRUE(result) << result.error().what;
    EXPECT_TRUE(result->arrays().features.empty());
    EXPECT_EQ(test::copyOf(result->arrays().triangles),
              test::copyOf(test::goldenCube().arrays().triangles));
  }
}

TEST_F(MrmDamage, AFeaturesNameIsText) {
  const auto named = [&](const std::string& name) {
    MrmBytes file = golden_;
    MrmBytes::Entry entry = file.entry(6);
    entry.name[name.copy(entry.name, sizeof entry.name - 1)] = 0;
    file.set(6, entry);
    return file.seal().bytes;
  };
  for (const char* name : {"he\x1b[31mat", "he\xff", "\xc2\x9bheat"})
    EXPECT_EQ(faultOf(named(name)), "a feature's name is not valid UTF-8");
  // An earlier version of MERLIN cut names in the middle of a UTF-8 character.
  const auto cut = read(named(std::string(30, 'x') + '\xc2'));
  ASSERT_TRUE(cut) << cut.error().what;
  EXPECT_EQ(cut->arrays().features[0].name, std::string(30, 'x'));
}

// Turns the golden file's last feature, 168 bytes, into a texture.
TEST_F(MrmDamage, ATextureIsCheckedAsAllElseIs) {
  MrmBytes file = golden_;
  MrmBytes::Entry entry = file.entry(6);
  entry.kind = 1000;
  entry.dimension = 1;
  entry.rows = 7;
  file.set(6, entry);
  const auto result = read(file.seal().bytes);
  ASSERT_TRUE(result) << result.error().what;
  EXPECT_EQ(result->arrays().texture.size(), 7U);
  file.bytes[entry.offset + 6] ^= 1;
  EXPECT_EQ(faultOf(file.bytes), "section texture is damaged");
}

// Only later readers know the size of a value of an unknown kind, which here is 1 or 8 bytes.
TEST_F(MrmDamage, AnUnknownSectionMayHoldValuesOfAnySize) {
  for (const std::uint32_t dimension : {168U, 21U}) {
    MrmBytes file = golden_;
    MrmBytes::Entry entry = file.entry(6);
    entry.kind = 1999;
    entry.dimension = dimension;
    entry.rows = 1;
    file.set(6, entry);
    EXPECT_EQ(faultOf(file.sealTable().bytes), "none") << dimension;
    entry.kind = 999;
    file.set(6, entry);
    EXPECT_EQ(faultOf(file.sealTable().bytes, Errc::kUnsupported), "section kind 999 is not known");
  }
}

TEST_F(MrmDamage, AFileHas1024SectionsAtMost) {
  for (const std::uint32_t sections : {1024U, 1025U}) {
    MrmBytes file = golden_;
    MrmBytes::Header header = file.header();
    const std::size_t more = (sections - header.sections) * sizeof(MrmBytes::Entry);
    file.bytes.insert(MrmBytes::entryAt(header.sections), more, '\0');
    header.sections = sections;
    header.file_size += more;
    file.set(header);
    for (std::size_t i = 0; i < sections; ++i) {
      MrmBytes::Entry entry = file.entry(i);
      i < 7 ? entry.offset += more : entry.kind = 1999;
      file.set(i, entry);
    }
    EXPECT_EQ(faultOf(file.sealTable().bytes),
              sections == 1024 ? "none" : "the section table is damaged");
  }
}

TEST_F(MrmDamage, ASectionOutsideTheFileIsRefused) {
  const std::vector<std::function<void(MrmBytes::Entry&)>> changes = {
      [](auto& e) { e.offset += 4; },                      // misaligned for a section
      [](auto& e) { e.offset = 1408; },                    // the next aligned offset beyond the end
      [](auto& e) { e.offset = ~std::uint64_t{0} - 63; },  // so that offset + size overflows
      [](auto& e) { e.rows = 1'000'000; },                 //
      [](auto& e) { e.rows = (1344 - e.offset) / 4 + 20; },  // slightly too many
      [](auto& e) { e.rows = std::uint64_t{1} << 62; },      // times 4 overflows to 0
      [](auto& e) { e.rows = ~std::uint64_t{0}; },           //
      [](auto& e) { e.dimension = 0; },                      //
      [](auto& e) { e.dimension = 0xFFFFFFFF; },             //
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_EQ(faultWith(Kind::kAlive, changes[i]), "section alive does not lie in the file") << i;
  }
}

TEST_F(MrmDamage, AMissingSectionIsRefused) {
  const auto skip = [](MrmBytes::Entry& e) { e.kind = 1999; };
  for (const Kind kind : {Kind::kPositions, Kind::kParents, Kind::kTriangles}) {
    EXPECT_EQ(faultWith(kind, skip),
              "a section is missing, or its size is not what the header says");
  }
  for (const Kind kind : {Kind::kAlive, Kind::kError}) {
    EXPECT_TRUE(faultWith(kind, skip).starts_with("6 collapses need 7 levels"));
  }
  EXPECT_EQ(faultWith(Kind::kAbout, skip), "none");
}

TEST_F(MrmDamage, AHeaderThatLiesIsRefused) {
  const std::string counts = "a section is missing, or its size is not what the header says";
  EXPECT_EQ(faultWith([](auto& h) { h.nodes = 15; }), counts);
  EXPECT_EQ(faultWith([](auto& h) { h.collapses = 5; }), counts);
  EXPECT_EQ(faultWith([](auto& h) { h.triangles = 13; }), counts);
  EXPECT_EQ(faultWith([](auto& h) { h.file_size = 1385; }),
            "has 1384 bytes, its header says 1385: cut short or overwritten");
  EXPECT_EQ(faultWith([](auto& h) { h.sections = 0; }), counts);
  for (const unsigned sections : {22U, 1024U, 1025U, 0xFFFFFFFFU}) {
    EXPECT_EQ(faultWith([&](auto& h) { h.sections = sections; }), "the section table is damaged");
  }
}

// The checksums are valid, but a cut with these arrays would fail, so Dendrogram::make() has to
// refuse them.
TEST_F(MrmDamage, SoundBytesWithoutSenseAreRefused) {
  const auto faultOfPut = [&](Kind kind, std::size_t index, auto value) {
    MrmBytes file = golden_;
    file.put(kind, index, value);
    return faultOf(file.seal().bytes);
  };
  EXPECT_EQ(
      faultOfPut(Kind::kParents, 0, 13U),
      "collapse 0: the number of the parent, 13, is not less than the numbers of its children");
  EXPECT_EQ(faultOfPut(Kind::kTriangles, 35, 14U),
            "triangle 11: there is no node 14, the model has 14");
  EXPECT_EQ(faultOfPut(Kind::kAlive, 6, 5U), "level 6: 5 triangles, at most 2 are possible");
  EXPECT_EQ(faultOfPut(Kind::kError, 6, 0.5F),
            "level 6: its error is not finite, or is less than the error of the level before it");
  EXPECT_EQ(faultOfPut(Kind::kPositions, 0, std::nanf("")), "a position is not finite");
}

}  // namespace
}  // namespace merlin::render
