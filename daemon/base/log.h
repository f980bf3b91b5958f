// Logging: one line an event to stderr, which systemd's journal takes as it is.
//
// Under the journal (JOURNAL_STREAM is set) a line starts with its syslog priority, "<4>", and
// carries no time; in a terminal it starts with the time of day. Pure folders do not log: they
// return Results, and the composition root says what happened.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace merlin {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

// Once, before any thread starts. Lines below `lowest` are dropped.
void initLog(LogLevel lowest);

// Thread-safe.
void logLine(LogLevel level, std::string_view text);

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

// To standard error as fmt::print() does, but where that cannot be written (it is closed, a disk is
// full) nothing happens: no work ends for want of a place for its words.
template <typename... Args>
void printError(fmt::format_string<Args...> format, Args&&... args) {
  const std::string text = fmt::format(format, std::forward<Args>(args)...);
  std::fwrite(text.data(), 1, text.size(), stderr);
}

// First of all: where descriptor 0, 1 or 2 is closed, /dev/null takes its place. Else the next file
// would, and the log would be written into shared memory.
void openStandardStreams();

}  // namespace merlin
