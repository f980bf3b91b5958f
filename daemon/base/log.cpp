#include "daemon/base/log.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <optional>

#include <fcntl.h>
#include <poll.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "daemon/base/printable_text.h"

namespace merlin {
namespace {

spdlog::level::level_enum toSpdlog(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug: return spdlog::level::debug;
    case LogLevel::kInfo: return spdlog::level::info;
    case LogLevel::kWarning: return spdlog::level::warn;
    case LogLevel::kError: return spdlog::level::err;
  }
  return spdlog::level::info;
}

std::string_view syslogPriority(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug: return "7";
    case LogLevel::kInfo: return "6";
    case LogLevel::kWarning: return "4";
    case LogLevel::kError: return "3";
  }
  return "6";
}

// Writes to standard error without blocking: a stopped pager or a hanging reader of the log must
// not block the daemon. Lines that cannot be written are counted; the next line reports their
// number.
class PatientSink final : public spdlog::sinks::base_sink<std::mutex> {
 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    if (line.size() > kMostBytes) {  // a pipe with room takes this many at once
      line.resize(kMostBytes);
      line[kMostBytes - 1] = '\n';
    }
    if (lost_ > 0 && hasRoom()) {
      const std::string said = fmt::format("({} lines of the log were lost)\n", lost_);
      if (write(said)) lost_ = 0;
    }
    if (lost_ > 0 || !hasRoom() || !write({line.data(), line.size()})) ++lost_;
  }
  void flush_() override {}

 private:
  static constexpr std::size_t kMostBytes = 4096;  // PIPE_BUF

  static bool hasRoom() {
    pollfd error{STDERR_FILENO, POLLOUT, 0};
    return ::poll(&error, 1, 0) == 1 && (error.revents & POLLOUT) != 0;
  }
  // A partial write counts as written: on a full disk, waiting would not help.
  static bool write(std::string_view text) {
    return ::write(STDERR_FILENO, text.data(), text.size()) > 0;
  }

  std::uint64_t lost_ = 0;
};

// Set by initLog(), before any thread starts.
struct Target {
  bool has_priority = std::getenv("JOURNAL_STREAM") != nullptr;  // whether lines begin with it
  std::optional<Journal> journal;
};
Target& target() {
  static Target the_target;
  return the_target;
}

bool sendToJournal(LogLevel level, std::string_view line, const LogFields& fields) {
  const std::array<JournalField, 5> all{{{"PRIORITY", syslogPriority(level)},
                                         {"SYSLOG_IDENTIFIER", program_invocation_short_name},
                                         {"MERLIN_KIND", fields.kind},
                                         {"MERLIN_ROLE", fields.role},
                                         {"MESSAGE", line}}};
  return target().journal->send(journalDatagram(all));
}

}  // namespace

void openStandardStreams() {
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(fd, F_GETFD) < 0 && errno == EBADF) (void)::open("/dev/null", O_RDWR);
  }
}

void initLog(LogLevel lowest, const char* journal) {
  if (isJournalStream(STDERR_FILENO, std::getenv("JOURNAL_STREAM")))
    target().journal.emplace(journal);
  auto logger = std::make_shared<spdlog::logger>("merlin", std::make_shared<PatientSink>());
  logger->set_pattern(target().has_priority ? "%v" : "%H:%M:%S.%e %l: %v");
  logger->set_level(toSpdlog(lowest));
  logger->flush_on(spdlog::level::debug);
  spdlog::set_default_logger(std::move(logger));
}

void logLine(LogLevel level, std::string_view text, const LogFields& fields) {
  if (!spdlog::should_log(toSpdlog(level))) return;
  const std::string line = oneLine(text);
  if (target().journal && sendToJournal(level, line, fields)) return;
  if (target().has_priority)
    spdlog::log(toSpdlog(level), "<{}>{}", syslogPriority(level), line);
  else
    spdlog::log(toSpdlog(level), "{}", line);
}

}  // namespace merlin
