// merlin config edit, with scripts as editors: what is saved, what is not, and who owns the file.
#include <filesystem>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/system/merlind.h"

namespace merlin::test {
namespace {

namespace fs = std::filesystem;

class ConfigEdit : public testing::Test {
 protected:
  ConfigEdit() {
    writeText(file_, kOld);
    // Mode and owner differ from this process's defaults, so that the test notices if a new file
    // replaces the old one.
    EXPECT_EQ(::chmod(file_.c_str(), 0640), 0);
    if (::geteuid() == 0) {
      EXPECT_EQ(::chown(file_.c_str(), 65534, 65533), 0);
    }
  }
  // Starts `merlin config edit`. `script`: the commands that the editor runs on the file "$1".
  std::unique_ptr<Process> edit(const std::string& script, const std::string& variable = "EDITOR") {
    const std::string editor = dir_ / "editor";
    writeText(editor, "#!/bin/sh\n" + script + "\n");
    EXPECT_EQ(::chmod(editor.c_str(), 0755), 0);
    return std::make_unique<Process>(std::vector<std::string>{kMerlin, "config", "edit", file_},
                                     std::map<std::string, std::string>{{variable, editor}});
  }
  void expectSaved(const std::string& content) const {
    EXPECT_EQ(readText(file_), content);
    struct stat status {};
    ASSERT_EQ(::stat(file_.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777U, 0640U);
    if (::geteuid() == 0) {
      EXPECT_EQ(status.st_uid, 65534U);
    }
    if (::geteuid() == 0) {
      EXPECT_EQ(status.st_gid, 65533U);
    }
    EXPECT_FALSE(fs::exists(copy_)) << "the copy is gone";
    std::vector<std::string> left;
    for (const auto& entry : fs::directory_iterator(dir_.path()))
      left.push_back(entry.path().filename());
    EXPECT_LE(left.size(), 3U) << testing::PrintToString(left);
  }

  static constexpr const char* kOld = "{\n\"wall\": {\"rate\": {\"rate_hz\": 25}}}";
  TempDir dir_;
  std::string file_ = dir_ / "merlin.json", copy_ = dir_ / ".merlin.edit.json";
};

TEST_F(ConfigEdit, AValidOneIsSavedWithOwnerAndMode) {
  const auto process = edit("sed -i s/25/40/ \"$1\"");
  EXPECT_EQ(process->wait(), 0) << process->output();
  EXPECT_NE(process->output().find(file_ + ": saved\n"), std::string::npos) << process->output();
  expectSaved("{\n\"wall\": {\"rate\": {\"rate_hz\": 40}}}");
}

TEST_F(ConfigEdit, AnInvalidOneIsEditedAgain) {
  const auto process = edit(
      "if grep -q 25 \"$1\"; then sed -i 's/25}/25, \"speed\": 1}/' \"$1\";\n"
      "else echo '{\"instance\": \"lab\"}' >\"$1\"; fi\n"
      "sed -i s/25/26/ \"$1\"");
  EXPECT_TRUE(process->saysEventually("(e)dit again, (k)eep the old one:")) << process->output();
  EXPECT_NE(process->output().find(file_ + ":2: /wall/rate/speed is not a known setting"),
            std::string::npos)
      << process->output();
  EXPECT_EQ(process->output().find(".merlin.edit"), std::string::npos) << process->output();
  EXPECT_EQ(readText(file_), kOld);
  process->type("save\ns\ne\n");  // "save" is not one of the answers
  EXPECT_EQ(process->wait(), 0) << process->output();
  expectSaved("{\"instance\": \"lab\"}\n");
}

TEST_F(ConfigEdit, TheOldOneIsKeptWhereThatIsWanted) {
  const auto process = edit("echo '{' >\"$1\"");
  EXPECT_TRUE(process->saysEventually("(k)eep the old one:")) << process->output();
  process->type("k\n");
  EXPECT_EQ(process->wait(), 2) << process->output();
  expectSaved(kOld);
}

TEST_F(ConfigEdit, NumbersThatAreClampedMayBeSaved) {
  const auto process = edit("sed -i s/25/900/ \"$1\"");
  EXPECT_TRUE(process->saysEventually("(s)ave:")) << process->output();
  process->type("s\n");
  EXPECT_EQ(process->wait(), 0) << process->output();
  expectSaved("{\n\"wall\": {\"rate\": {\"rate_hz\": 900}}}");
}

TEST_F(ConfigEdit, WithoutAChangeOrAnEditorNothingIsWritten) {
  const auto stamp = fs::last_write_time(file_);
  EXPECT_EQ(edit("true")->wait(), 0);
  const auto failed = edit("echo '{}' >\"$1\"; exit 3", "VISUAL");
  EXPECT_EQ(failed->wait(), 1);
  EXPECT_NE(failed->output().find("failed, exit status 3"), std::string::npos) << failed->output();
  expectSaved(kOld);
  EXPECT_EQ(fs::last_write_time(file_), stamp);
  const Outcome nothing = run({kMerlin, "config", "edit", dir_ / "no.json"});
  EXPECT_NE(nothing.status, 0);
  EXPECT_NE(nothing.output.find("no.json: No such file"), std::string::npos) << nothing.output;
}

TEST_F(ConfigEdit, ALinkStaysOne) {
  fs::create_directory(dir_ / "etc");
  fs::rename(file_, dir_ / "etc/real.json");
  fs::create_symlink(dir_ / "etc/real.json", file_);
  EXPECT_EQ(edit("sed -i s/25/40/ \"$1\"")->wait(), 0);
  EXPECT_TRUE(fs::is_symlink(file_));
  EXPECT_NE(readText(dir_ / "etc/real.json").find("40"), std::string::npos);
}

TEST_F(ConfigEdit, OnePersonAtATimeAndNobodyElsesChangeIsLost) {
  const UniqueFd other(::open(file_.c_str(), O_RDONLY | O_CLOEXEC));
  ASSERT_EQ(::flock(other.get(), LOCK_EX), 0);
  const auto second = edit("true");
  EXPECT_EQ(second->wait(), 3);
  EXPECT_NE(second->output().find("somebody else is editing it"), std::string::npos)
      << second->output();
  ASSERT_EQ(::flock(other.get(), LOCK_UN), 0);
  const auto process = edit("sed -i s/25/40/ \"$1\"; echo '{\"instance\": \"b\"}' >" + file_);
  EXPECT_EQ(process->wait(), 1) << process->output();
  EXPECT_NE(process->output().find("another program has changed this file since it was opened"),
            std::string::npos)
      << process->output();
  EXPECT_EQ(readText(file_), "{\"instance\": \"b\"}\n");
  EXPECT_NE(readText(copy_).find("40"), std::string::npos) << "the work is not lost";
}

TEST_F(ConfigEdit, ARunningMerlindReadsItAtOnceIfThatIsWanted) {
  Merlind m(dir_, makeModel(dir_, 5), "edited");
  ASSERT_TRUE(m.ready()) << m.process().output();
  file_ = m.config();
  const auto process = edit("sed -i 's/\"rate_hz\": 10.0/\"rate_hz\": 12/' \"$1\"");
  EXPECT_TRUE(process->saysEventually("Have it read its configuration now?")) << process->output();
  process->type("y\n");
  EXPECT_EQ(process->wait(), 0) << process->output();
  EXPECT_NE(process->output().find("/wall/rate/rate_hz: 10 -> 12"), std::string::npos)
      << process->output();
  EXPECT_TRUE(eventually([&] { return m.wall().rate_asked_hz == 12; }));
}

}  // namespace
}  // namespace merlin::test
