#include "daemon/reloader.h"

#include <algorithm>
#include <charconv>
#include <exception>

#include <fmt/format.h>

#include "config/drawn_wall.h"
#include "config/effective.h"
#include "daemon/base/log.h"
#include "daemon/wall/alignment_fit.h"
#include "daemon/wall/wall_checks.h"

namespace merlin {
namespace {

using reload::Outcome;
using reload::Part;

constexpr std::size_t kMostWaiting = 8, kKept = 32;
// Before it starts again, the process waits at most kFetch for the client that fetches its answer,
// and then kSend, so that the answer is sent.
constexpr Duration kFetch = std::chrono::seconds(5), kSend = std::chrono::milliseconds(200);
constexpr const char* kService = "configuration";

std::optional<std::uint32_t> numberIn(const std::string& text) {
  std::uint32_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  return number;
}

// Whether one of the changed settings had to be adjusted. A start uses the adjusted value, so that
// the wall runs at all; a reload refuses the file and keeps the previous settings.
bool adjustsChange(const LoadedSettings& loaded, const std::vector<SettingChange>& changes) {
  return std::ranges::any_of(loaded.findings, [&](const Finding& finding) {
    return std::ranges::any_of(changes, [&](const SettingChange& change) {
      return finding.pointer == change.pointer || finding.pointer.starts_with(change.pointer + "/");
    });
  });
}

bool concerns(const std::vector<SettingChange>& changes, std::string_view group) {
  return std::ranges::any_of(
      changes, [&](const SettingChange& change) { return change.pointer.starts_with(group); });
}

std::string orNothing(const std::string& value) { return value.empty() ? "nothing" : value; }

}  // namespace

Reloader::Reloader(std::string file, const DaemonOptions& options, Configured configured,
                   Settings& running, const Parts& parts)
    : file_(std::move(file)),
      options_(options),
      configured_(std::move(configured)),
      running_(running),
      parts_(parts) {}

void Reloader::request() {
  const std::lock_guard lock(mutex_);
  (void)add(false, false);
}

// REQUIRES: mutex_ is held.
Result<std::string> Reloader::add(bool only_check, bool is_command) {
  // The restart that is due reads the file again, and so fulfils this request, too.
  if (restart_at_) return fmt::format("{{\"request\": {}}}", restart_number_);
  if (waiting_.size() >= kMostWaiting) {
    return Error{Errc::kBusy,
                 fmt::format("{} requests wait already; try again later", kMostWaiting)};
  }
  waiting_.push_back({++last_number_, only_check, is_command});
  parts_.wake();
  return fmt::format("{{\"request\": {}}}", last_number_);
}

Result<std::string> Reloader::run(const std::string& argument) {
  const std::lock_guard lock(mutex_);
  if (argument == "now" || argument == "check") return add(argument == "check", true);
  const auto number = numberIn(argument);
  const auto answer =
      std::ranges::find_if(answers_, [&](const auto& a) { return a.first == number; });
  if (answer != answers_.end()) {
    if (restart_at_ && number == restart_number_)
      restart_at_ = std::min(*restart_at_, parts_.clock.now() + kSend);
    return answer->second;
  }
  const bool waits = std::ranges::any_of(waiting_, [&](auto& r) { return r.number == number; });
  if (waits || (current_ && current_->number == number)) return std::string("{\"pending\": true}");
  return Error{
      Errc::kInvalidArgument,
      fmt::format("\"{}\" is neither now nor check nor the number of one of the last {} requests",
                  argument.substr(0, 64), kKept)};
}

Reloader::Done Reloader::tend() {
  std::optional<Request> request;
  std::optional<ReadFile> file;
  {
    const std::lock_guard lock(mutex_);
    if (restart_at_) return parts_.clock.now() >= *restart_at_ ? Done::kRestart : Done::kNothing;
    if (read_) {
      request = current_;
      file.swap(read_);
    }
  }
  Done done = Done::kNothing;
  if (file) {
    thread_.stop();
    done = finish(*request, *std::move(file));
  }
  const std::lock_guard lock(mutex_);
  if (current_ || waiting_.empty() || restart_at_) return done;
  current_ = waiting_.front();
  waiting_.pop_front();
  thread_ = WatchedThread(parts_.watch, "reload",
                          [this](const std::stop_token& stop, Progress& p) { read(stop, p); });
  return done;
}

// The body of the thread. After reading, it waits until it is stopped, as every thread must.
void Reloader::read(const std::stop_token& stop, Progress& progress) {
  giveWay();
  ReadFile file;
  {
    const Progress::Pause pause(progress);  // a file system may take long, or never answer
    file = readGuarded();
  }
  std::unique_lock lock(mutex_);
  read_ = std::move(file);
  parts_.wake();
  while (!stop.stop_requested()) {
    progress.step();
    ending_.wait_for(lock, stop, std::chrono::milliseconds(200), [] { return false; });
  }
}

Reloader::ReadFile Reloader::readGuarded() const {
  try {
    return read();
  } catch (const std::exception& e) {  // for example, no memory is left
    ReadFile failed;
    failed.answer.outcome = Outcome::kFailed;
    failed.answer.file = file_;
    failed.answer.failure = e.what();
    return failed;
  }
}

reload::Readers Reloader::process() const {
  const bool mirrors = options_.wall && !configured_.settings.wall.input.endpoint.empty();
  return (options_.devices ? reload::kDevices : 0U) | (options_.wall ? reload::kWall : 0U) |
         (mirrors ? reload::kMirror : 0U);
}

// Checks the changed settings for the faults that only a start finds, and that would end the
// process when it starts again.
void Reloader::checkStart(LoadedSettings& loaded, const std::vector<SettingChange>& changes) const {
  if (!options_.wall) return;
  if (concerns(changes, "/wall/render/gpu")) wall::checkRenderer(loaded);
  if (concerns(changes, "/wall/model") || concerns(changes, "/wall/contents") ||
      concerns(changes, "/wall/render/show"))
    wall::checkContents(loaded);
  loaded.sortFindings();
}

Outcome Reloader::judge(LoadedSettings& loaded, const NamedFiles& named, reload::Plan& plan) const {
  if (loaded.verdict() == LoadedSettings::Verdict::kInvalid) return Outcome::kInvalid;
  auto changes = changesBetween(configured_.settings, loaded.settings);
  for (SettingChange& change : changesBetween(configured_.named, named))
    changes.push_back(std::move(change));
  reload::Plan found = reload::planFor(changes, process());
  if (!found.restart.empty()) checkStart(loaded, changes);
  if (loaded.verdict() == LoadedSettings::Verdict::kInvalid || adjustsChange(loaded, changes))
    return Outcome::kInvalid;
  plan = std::move(found);
  return plan.restart.empty() ? Outcome::kDone : Outcome::kRestarts;
}

Reloader::ReadFile Reloader::read() const {
  LoadedSettings loaded = readConfiguration(file_, options_, Reading::kAgain).loaded;
  ReadFile file;
  file.answer.file = file_;
  file.named = readNamedFiles(loaded.settings);
  file.answer.outcome = judge(loaded, file.named, file.answer.plan);
  file.answer.findings = findingLines(file_, loaded);
  file.settings = std::move(loaded.settings);
  if (file.answer.outcome == Outcome::kDone && options_.devices) {
    if (auto trained = devices::loadTrained(file.settings)) {
      file.trained = *std::move(trained);
    } else {  // a file was changed after readConfiguration() had checked it
      file.answer.outcome = Outcome::kInvalid;
      file.answer.findings.push_back(fmt::format("{}: /postures or /gestures cannot be used: {}",
                                                 file_, trained.error().what));
    }
  }
  fitAlignments(file);
  return file;
}

// Adds to the answer which alignments the wall sets aside or brings back, if the file changes
// settings that the wall's aligner uses.
void Reloader::fitAlignments(ReadFile& file) const {
  reload::Answer& answer = file.answer;
  const bool fits = answer.outcome == Outcome::kRestarts ||
                    (answer.outcome == Outcome::kDone && answer.plan.has(Part::kCorrection));
  if (!options_.wall || !parts_.keeper || !fits) return;
  const state::State state = parts_.keeper->state();
  for (auto& [output, fitted] :
       wall::fittedOutputs(drawnWall(file.settings.wall), state.alignment, state.set_aside)) {
    if (!fitted.aside_why.empty()) answer.set_aside.push_back({output, fitted.aside_why});
    if (fitted.is_back) answer.brought_back.push_back(output);
  }
}

Reloader::Done Reloader::finish(const Request& request, ReadFile file) {
  file.answer.only_checked = request.only_check;
  const bool swaps = !request.only_check && file.answer.outcome == Outcome::kDone;
  if (swaps) swap(file);
  if (!request.only_check) report(file.answer);
  std::string text = reload::answerText(file.answer);
  const std::lock_guard lock(mutex_);
  answers_.emplace_back(request.number, std::move(text));
  if (answers_.size() > kKept) answers_.pop_front();
  current_.reset();
  if (!request.only_check && file.answer.outcome == Outcome::kRestarts) {
    restart_at_ = parts_.clock.now() + (request.is_command ? kFetch : Duration{});
    restart_number_ = request.number;
  }
  return swaps ? Done::kSwapped : Done::kNothing;
}

void Reloader::swap(const ReadFile& file) {
  const reload::Plan& plan = file.answer.plan;
  reload::adopt(plan, file.settings, options_.emulate, running_);
  if (parts_.devices) {
    parts_.devices->reload(
        running_,
        {plan.has(Part::kBindings), plan.has(Part::kHand), plan.has(Part::kPostures),
         plan.has(Part::kGestures) || plan.has(Part::kScene), plan.lines},
        file.trained);
  }
  if (parts_.wall) {
    parts_.wall->reload(
        running_,
        {plan.has(Part::kRate), plan.has(Part::kPlaylist), plan.has(Part::kScene),
         plan.has(Part::kBindings) || plan.has(Part::kHand), plan.has(Part::kCorrection)});
  }
  configured_ = {file.settings, file.named};
}

void Reloader::report(const reload::Answer& answer) {
  for (const std::string& finding : answer.findings) logWarning("{}", finding);
  const std::string refusal = reload::refusal(answer);
  if (!refusal.empty()) return parts_.services.failed(kService, refusal);
  parts_.services.ok(kService);
  if (answer.outcome == Outcome::kRestarts) {
    return logInfo(
        "reload: {} changed in {}, which takes effect at a start only: merlind starts again",
        reload::restartReason(answer.plan), file_);
  }
  for (const SettingChange& change : answer.plan.swapped) {
    logInfo("reload: {} was {} and is {}", change.pointer, orNothing(change.before),
            orNothing(change.after));
  }
  logInfo("reload: {} was read again; {}", file_,
          answer.plan.swapped.empty() ? "nothing changed for this process"
                                      : "all changes are in effect");
}

}  // namespace merlin
