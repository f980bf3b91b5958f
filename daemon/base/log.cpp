#include "daemon/base/log.h"

#include <cstdlib>
#include <memory>

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "daemon/base/text.h"

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
    case LogLevel::kDebug: return "<7>";
    case LogLevel::kInfo: return "<6>";
    case LogLevel::kWarning: return "<4>";
    case LogLevel::kError: return "<3>";
  }
  return "<6>";
}

bool underJournal() {
  static const bool journal = std::getenv("JOURNAL_STREAM") != nullptr;
  return journal;
}

}  // namespace

void initLog(LogLevel lowest) {
  auto logger =
      std::make_shared<spdlog::logger>("merlin", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern(underJournal() ? "%v" : "%H:%M:%S.%e %l: %v");
  logger->set_level(toSpdlog(lowest));
  logger->flush_on(spdlog::level::debug);
  spdlog::set_default_logger(std::move(logger));
}

void logLine(LogLevel level, std::string_view text) {
  if (underJournal()) {
    spdlog::log(toSpdlog(level), "{}{}", syslogPriority(level), oneLine(text));
  } else {
    spdlog::log(toSpdlog(level), "{}", oneLine(text));
  }
}

}  // namespace merlin
