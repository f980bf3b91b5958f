// A wall whose model file is overwritten, cut, replaced or removed while the wall draws.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

class ModelFiles : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = new TempDir;
    for (const int percent : {5, 10, 20}) {
      const std::string made = makeModel(*dir_, percent);
      std::filesystem::rename(made, part(percent));
    }
  }
  static void TearDownTestSuite() { delete dir_; }
  static std::string part(int percent) { return *dir_ / (std::to_string(percent) + ".mrm"); }

  // Overwrites the file in place, as cp does: the inode remains the same.
  static void overwrite(const std::string& path, const std::string& bytes) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary | std::ios::trunc);
    file << bytes;
  }
  void expectDrawing() {
    const auto frames = [&] { return m_->wall().deadlines; };
    const auto from = frames();
    EXPECT_TRUE(eventually([&] { return frames() > from + 10 || m_->process().ended(); }));
    EXPECT_FALSE(m_->process().ended()) << m_->process().output();
  }
  std::size_t said(const std::string& text) const {
    const std::string output = m_->process().output();
    std::size_t times = 0;
    for (auto at = output.find(text); at != std::string::npos; at = output.find(text, at + 1))
      ++times;
    return times;
  }
  // Makes the change; expects that the log then has the sentence, and that the wall goes on
  // drawing.
  void expect(const std::string& sentence, const std::function<void()>& change) {
    const std::size_t before = said(sentence);
    change();
    EXPECT_TRUE(eventually([&] { return said(sentence) > before || m_->process().ended(); }))
        << m_->process().output();
    expectDrawing();
  }

  static TempDir* dir_;
  std::unique_ptr<Merlind> m_;
};
TempDir* ModelFiles::dir_ = nullptr;

TEST_F(ModelFiles, WhateverHappensToThemTheWallDrawsOn) {
  const std::string live = *dir_ / "live.mrm";
  std::filesystem::copy_file(part(10), live);
  const std::string shown = "model " + live + " was replaced and is shown",
                    refused = "cannot be shown";
  m_ = std::make_unique<Merlind>(*dir_, live, "files", MerlindOptions{.script = "turning"});
  ASSERT_TRUE(m_->ready()) << m_->process().output();
  const auto levels = m_->wall().detail_steps;

  expect(shown, [&] { overwrite(live, readText(part(5))); });  // as with `cp smaller.mrm live.mrm`
  EXPECT_TRUE(eventually([&] { return m_->wall().detail_steps < levels; })) << "it is the new one";
  const auto smaller = m_->wall().detail_steps;
  expect(refused, [&] { std::filesystem::resize_file(live, 0); });
  expect(refused, [&] { overwrite(live, std::string(std::filesystem::file_size(part(5)), 'x')); });
  std::string half = readText(part(20));
  half.resize(half.size() / 2);
  expect(refused, [&] { overwrite(live, half); });
  EXPECT_EQ(m_->wall().detail_steps, smaller) << "the last good one stays";
  expect(shown, [&] {
    std::filesystem::copy_file(part(20), live + ".new");
    std::filesystem::rename(live + ".new", live);
  });
  EXPECT_TRUE(eventually([&] { return m_->wall().detail_steps > levels; }));
  std::filesystem::remove(live);
  expectDrawing();
  EXPECT_EQ(said(shown), 2u);
  EXPECT_EQ(said(refused), 3u);
  EXPECT_EQ(m_->process().kill(SIGTERM), 0) << m_->process().output();
}

// Files of the right size and with right checksums, but with wrong indices, are tested in
// mrm_damage_test. Here nothing moves, and the new model must appear without any input.
TEST_F(ModelFiles, AStillWallShowsTheNewOneByItself) {
  const std::string live = *dir_ / "still.mrm";
  std::filesystem::copy_file(part(5), live);
  m_ = std::make_unique<Merlind>(*dir_, live, "stillfiles", MerlindOptions{.script = "still"});
  ASSERT_TRUE(m_->ready()) << m_->process().output();
  ASSERT_TRUE(eventually([&] { return m_->wall().full_detail == 1; }));
  const auto triangles = m_->wall().cost;
  overwrite(live, readText(part(10)));
  EXPECT_TRUE(eventually([&] {
    return m_->wall().full_detail == 1 && m_->wall().cost > triangles;
  })) << m_->process().output();
  EXPECT_EQ(m_->process().kill(SIGTERM), 0) << m_->process().output();
}

}  // namespace
}  // namespace merlin::test
