#include "daemon/last_good.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "config/writer.h"
#include "daemon/base/absolute_path.h"
#include "daemon/base/files.h"
#include "daemon/base/log.h"
#include "daemon/state/state_folder.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

constexpr Duration kStep = std::chrono::milliseconds(200);

}  // namespace

// "etc-merlin-merlin.json.wall.last-good": configurations of the same name may be in several
// folders, and each role checks other files. A dash of the name is doubled.
std::string lastGoodFile(const std::string& configuration, const std::string& role) {
  const std::string folder = state::stateFolder(), path = absolutePath(configuration);
  if (folder.empty() || path.empty()) return {};
  std::string name;
  for (const char c : path.substr(1)) name += c == '/' ? "-" : c == '-' ? "--" : std::string(1, c);
  return fmt::format("{}/{}.{}.last-good", folder, name, role);
}

std::optional<Configuration> readLastGood(const std::string& file, const Configuration& broken,
                                          const DaemonOptions& options) {
  std::error_code error;
  if (file.empty() || !fs::exists(file, error)) return std::nullopt;
  Configuration kept = readConfiguration(file, options);
  for (const std::string& line : findingLines(file, kept.loaded)) logWarning("{}", line);
  if (kept.loaded.verdict() == LoadedSettings::Verdict::kInvalid) return std::nullopt;
  kept.file = broken.file;  // what a reload reads
  const auto findings = findingLines(broken.file, broken.loaded);
  kept.instead_of = fmt::format(
      "{}; merlind runs with the last valid configuration, kept in {}: correct the file, then "
      "`merlin reload`",
      findings.empty() ? broken.file + " is invalid" : findings.front(), file);
  return kept;
}

LastGoodKeeper::LastGoodKeeper(std::string file, ThreadWatch& watch)
    : file_(std::move(file)),
      thread_(watch, "last good configuration",
              [this](const std::stop_token& stop, Progress& progress) { loop(stop, progress); }) {}

LastGoodKeeper::~LastGoodKeeper() { thread_.stop(); }

void LastGoodKeeper::keep(const Settings& settings) {
  std::string text = settingsText(settings);
  const std::lock_guard lock(mutex_);
  waiting_ = std::move(text);
  wake_.notify_one();
}

void LastGoodKeeper::loop(const std::stop_token& stop, Progress& progress) {
  giveWay();
  for (;;) {
    std::optional<std::string> text;
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, stop, kStep, [this] { return waiting_.has_value(); });
      text = std::exchange(waiting_, std::nullopt);
    }
    progress.step();
    if (text) {
      const Progress::Pause pause(progress);  // a disk may take its time
      write(*text);
    } else if (stop.stop_requested()) {
      return;
    }
  }
}

void LastGoodKeeper::write(const std::string& text) {
  std::error_code ignored;
  fs::create_directories(fs::path(file_).parent_path(), ignored);
  const auto written = writeFile(file_, text);
  const std::string why = written ? std::string() : written.error().what;
  if (!why.empty() && why != logged_)
    logWarning("the last good configuration is not kept: {}: {}", file_, why);
  logged_ = why;
}

}  // namespace merlin
