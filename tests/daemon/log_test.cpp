// Lines of the log: with fields if standard error is the journal, otherwise as text.
#include "daemon/base/log.h"

#include <array>
#include <cstdlib>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/temp_dir.h"

namespace merlin {
namespace {

std::string streamOf(int fd) {
  struct stat found {};
  EXPECT_EQ(::fstat(fd, &found), 0);
  return std::to_string(found.st_dev) + ":" + std::to_string(found.st_ino);
}

TEST(Journal, IsTheStreamThatSystemdNames) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  EXPECT_TRUE(isJournalStream(pipe[1], streamOf(pipe[1]).c_str()));
  EXPECT_FALSE(isJournalStream(pipe[1], (streamOf(pipe[1]) + "0").c_str()));
  EXPECT_FALSE(isJournalStream(pipe[1], ""));
  EXPECT_FALSE(isJournalStream(pipe[1], nullptr));
  const std::string was = streamOf(pipe[1]);
  ::close(pipe[1]);
  EXPECT_FALSE(isJournalStream(pipe[1], was.c_str()));
  ::close(pipe[0]);
}

TEST(Journal, ADatagramHasALineAField) {
  const std::array<JournalField, 3> fields{
      {{"PRIORITY", "4"}, {"MERLIN_KIND", ""}, {"MESSAGE", "a=b"}}};
  EXPECT_EQ(journalDatagram(fields), "PRIORITY=4\nMESSAGE=a=b\n");
  const std::array<JournalField, 1> lines{{{"MESSAGE", "a\nbc"}}};
  EXPECT_EQ(journalDatagram(lines), std::string("MESSAGE\n\x04\0\0\0\0\0\0\0", 16) + "a\nbc\n");
}

// A process that logs. Its standard error is a pipe, which JOURNAL_STREAM may declare to be the
// journal's; the journal itself is a socket of the test.
class LogTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(::pipe(error_.data()), 0);
    journal_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
    sockaddr_un at{};
    at.sun_family = AF_UNIX;
    path_.copy(at.sun_path, sizeof at.sun_path - 1);
    ASSERT_EQ(::bind(journal_, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
  }
  void TearDown() override {
    ::close(journal_);
    ::close(error_[0]);
  }

  // Logs an event and a line without fields. `stream`: the value of JOURNAL_STREAM; null: not set.
  void logInAProcess(const char* stream, const std::string& journal) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::dup2(error_[1], STDERR_FILENO);
      if (stream == nullptr) ::unsetenv("JOURNAL_STREAM");
      if (stream != nullptr) ::setenv("JOURNAL_STREAM", stream, 1);
      initLog(LogLevel::kInfo, journal.c_str());
      logLine(LogLevel::kWarning, "output png failed:\nno space", {kWallKind, "wall"});
      logInfo("ready");
      logLine(LogLevel::kDebug, "is not to be seen");
      ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
    ::close(error_[1]);
  }
  std::string datagram() const {
    std::array<char, 1000> text{};
    const ssize_t size = ::recv(journal_, text.data(), text.size(), 0);
    return size < 0 ? "none" : std::string(text.data(), static_cast<std::size_t>(size));
  }
  std::string onStandardError() const {
    std::string all;
    std::array<char, 1000> text{};
    for (ssize_t size = 0; (size = ::read(error_[0], text.data(), text.size())) > 0;)
      all.append(text.data(), static_cast<std::size_t>(size));
    return all;
  }

  static constexpr const char* kWallKind = "wall";
  test::TempDir dir_;
  std::string path_ = dir_ / "journal";
  int journal_ = -1;
  std::array<int, 2> error_{};
};

TEST_F(LogTest, GoesToTheJournalWithFieldsWhereStandardErrorIsTheJournal) {
  logInAProcess(streamOf(error_[1]).c_str(), path_);
  EXPECT_EQ(datagram(),
            "PRIORITY=4\nSYSLOG_IDENTIFIER=log_test\nMERLIN_KIND=wall\nMERLIN_ROLE=wall\n"
            "MESSAGE=output png failed:\\x0ano space\n");
  EXPECT_EQ(datagram(), "PRIORITY=6\nSYSLOG_IDENTIFIER=log_test\nMESSAGE=ready\n");
  EXPECT_EQ(datagram(), "none");
  EXPECT_EQ(onStandardError(), "");
}

TEST_F(LogTest, IsTextWithAPriorityWhereTheJournalDoesNotTakeItOrIsElsewhere) {
  const char* const text = "<4>output png failed:\\x0ano space\n<6>ready\n";
  logInAProcess(streamOf(error_[1]).c_str(), dir_ / "nobody");
  EXPECT_EQ(onStandardError(), text);
  ::close(error_[0]);
  ASSERT_EQ(::pipe(error_.data()), 0);
  logInAProcess("8:12345", path_);
  EXPECT_EQ(onStandardError(), text);
  EXPECT_EQ(datagram(), "none");
}

TEST_F(LogTest, IsTextWithTheTimeWithoutAJournal) {
  logInAProcess(nullptr, path_);
  const std::string text = onStandardError();
  EXPECT_NE(text.find(" warning: output png failed"), std::string::npos) << text;
  EXPECT_EQ(text.find('<'), std::string::npos) << text;
  EXPECT_EQ(datagram(), "none");
}

}  // namespace
}  // namespace merlin
