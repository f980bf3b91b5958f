// Logging: one line per event, to systemd's journal or to stderr.
//
// Where stderr is the journal, a line is sent there with the fields PRIORITY, MESSAGE,
// SYSLOG_IDENTIFIER and those of LogFields. If the journal does not accept the line that way, or if
// JOURNAL_STREAM is set but stderr leads elsewhere, the line is written to stderr, begins with its
// syslog priority, "<4>", and has no time. In a terminal, a line begins with the time of day. Pure
// folders do not log: they return Results, and the composition root logs them.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "daemon/base/journal.h"

namespace merlin {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

// Fields by which the journal can be searched, as in `journalctl MERLIN_KIND=device`; an empty
// field is left out.
struct LogFields {
  std::string_view kind;  // MERLIN_KIND: EventKind::name
  std::string_view role;  // MERLIN_ROLE: "devices", "wall"
};

// To be called once, before any thread starts. Lines below `lowest` are dropped. `journal`: path of
// the journal's socket.
void initLog(LogLevel lowest, const char* journal = Journal::kSocket);

// Writes one line to the log. Thread-safe. Never blocks: if the reader of the log hangs, lines are
// dropped and their number is logged later.
void logLine(LogLevel level, std::string_view text, const LogFields& fields = {});

template <typename... Args>
void logInfo(fmt::format_string<Args...> format, Args&&... args) {
  logLine(LogLevel::kInfo, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void logWarning(fmt::format_string<Args...> format, Args&&... args) {
  logLine(LogLevel::kWarning, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void logError(fmt::format_string<Args...> format, Args&&... args) {
  logLine(LogLevel::kError, fmt::format(format, std::forward<Args>(args)...));
}

// Prints to standard error like fmt::print(), but ignores failures (closed stream, full disk), so
// that they cannot end the program.
template <typename... Args>
void printError(fmt::format_string<Args...> format, Args&&... args) {
  const std::string text = fmt::format(format, std::forward<Args>(args)...);
  std::fwrite(text.data(), 1, text.size(), stderr);
}

// To be called first: opens /dev/null for each of the descriptors 0, 1 and 2 that is closed.
// Otherwise the next file opened would get that number, and the log might be written into shared
// memory.
void openStandardStreams();

}  // namespace merlin
