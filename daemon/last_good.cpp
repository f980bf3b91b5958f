#include "daemon/last_good.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>

#include "config/writer.h"
#include "daemon/base/absolute_path.h"
#include "daemon/base/clock.h"
#include "daemon/base/log.h"
#include "daemon/base/restricted_file.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

constexpr Duration kStep = std::chrono::milliseconds(200);
constexpr Duration kTryAgain = std::chrono::seconds(5);  // after a failure: the disk may be full

// Removes from `mode` the permission bits that the file does not have; does nothing if the file is
// missing.
void restrictTo(const fs::path& file, mode_t& mode) {
  struct stat status {};
  if (::stat(file.c_str(), &status) == 0) mode &= status.st_mode;
}

// Returns the permissions of the kept file: 0640, or 0600 if the group may not read every file of
// the configuration. The group needs access because, under systemd's units, the roles page and
// alarms run as other users of the group merlin.
mode_t modeLike(const std::string& configuration) {
  mode_t mode = 0640;
  restrictTo(configuration, mode);
  std::error_code error;
  for (const auto& entry :
       fs::directory_iterator(fs::path(configuration).parent_path() / "conf.d", error)) {
    if (entry.path().extension() == ".json") restrictTo(entry.path(), mode);
  }
  return mode | 0600;
}

}  // namespace

std::optional<Configuration> readLastGood(const std::string& file, const Configuration& broken,
                                          const DaemonOptions& options) {
  std::error_code error;
  if (file.empty() || !fs::exists(file, error)) return std::nullopt;
  Configuration kept = readConfiguration(file, options);
  for (const std::string& line : findingLines(file, kept.loaded)) logWarning("{}", line);
  if (kept.loaded.verdict() == LoadedSettings::Verdict::kInvalid) return std::nullopt;
  kept.file = broken.file;  // the file that a reload reads
  const auto findings = findingLines(broken.file, broken.loaded);
  kept.instead_of = fmt::format(
      "{}; merlind runs with the last valid configuration, kept in {}: correct the file, then "
      "`merlin reload`",
      findings.empty() ? broken.file + " is invalid" : findings.front(), file);
  return kept;
}

LastGoodKeeper::LastGoodKeeper(std::string file, const std::string& configuration,
                               ThreadWatch& watch)
    : file_(std::move(file)),
      configuration_(absolutePath(configuration)),
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
  std::optional<std::string> unwritten;
  SystemClock clock;
  Timestamp next_try{};
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, stop, kStep, [this] { return waiting_.has_value(); });
      if (waiting_) {
        unwritten = std::exchange(waiting_, std::nullopt);
        next_try = clock.now();
      }
    }
    progress.step();
    const bool last = stop.stop_requested();
    if (unwritten && (last || clock.now() >= next_try)) {
      const Progress::Pause pause(progress);  // writing to a disk may take long
      if (write(*unwritten)) unwritten.reset();
      next_try = clock.now() + kTryAgain;
    }
    if (last) return;  // even if writing failed
  }
}

bool LastGoodKeeper::write(const std::string& text) {
  std::error_code ignored;
  fs::create_directories(fs::path(file_).parent_path(), ignored);
  const auto written = writeRestrictedFile(file_, text, modeLike(configuration_));
  const std::string why = written ? std::string() : written.error().what;
  if (!why.empty() && why != logged_) {
    logWarning("the last good configuration is not kept: {}: {}; tried again every {:.0f} s", file_,
               why, toSeconds(kTryAgain));
  }
  logged_ = why;
  return written.ok();
}

}  // namespace merlin
