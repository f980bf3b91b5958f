#include "daemon/wall/model_watch.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <fmt/format.h>

namespace merlin::wall {
namespace {

constexpr std::chrono::seconds kLook{1};
constexpr int kLooksUntilGone = 3;

}  // namespace

bool ReplacedFile::look(const std::optional<FileStamp>& found, Timestamp now) {
  if (!found) return false;  // being renamed, or removed: the model shown stays
  if (*found != seen_) {
    seen_ = *found;
    since_ = now;
  }
  if (seen_ == shown_ || now - since_ < kStable) return false;
  shown_ = seen_;
  return true;
}

ModelWatch::ModelWatch(std::vector<Watched> files, Make make, ThreadWatch& watch,
                       const Clock& clock)
    : files_(std::move(files)), make_(std::move(make)), clock_(clock) {
  for (const Watched& file : files_) replaced_.emplace_back(file.shown);
  gone_.resize(files_.size());
  thread_ =
      WatchedThread(watch, "models", [this](const std::stop_token& s, Progress& p) { run(s, p); });
}

void ModelWatch::run(const std::stop_token& stop, Progress& progress) {
  giveWay();
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  while (!stop.stop_requested()) {
    for (std::size_t place = 0; place < files_.size(); ++place) lookAt(place, progress);
    progress.step();
    stopped.wait_for(lock, stop, kLook, [] { return false; });
  }
}

// A file that cannot be shown is tried again only after it has changed.
void ModelWatch::lookAt(std::size_t place, Progress& progress) {
  const std::string& path = files_[place].path;
  const Progress::Pause pause(progress);  // a file server may be slow, and a model large
  const auto found = fileStamp(path);
  tellWhetherThere(place, found.has_value());
  if (!replaced_[place].look(found, clock_.now())) return;
  Result<ReadyModel> ready = Error{Errc::kIo, path + ": not enough memory"};
  try {
    ready = make_(place, path);
  } catch (const std::exception& e) {
    ready = Error{Errc::kIo, fmt::format("{}: {}", path, e.what())};
  }
  if (!ready) {
    say(
        fmt::format("the model's file was replaced by one that cannot be shown ({}); the model "
                    "that was read before stays",
                    ready.error().what));
    return;
  }
  const std::lock_guard lock(mutex_);
  // A model that is outdated before the wall took it is freed here, not on the wall's thread.
  std::erase_if(ready_, [&](const ReadyModel& r) { return r.place == place; });
  ready_.push_back(*std::move(ready));
}

// To be called once per check. Reports a missing file only after kLooksUntilGone checks, since a
// file that is being replaced may be missing for a moment.
void ModelWatch::tellWhetherThere(std::size_t place, bool there) {
  const bool was_gone = gone_[place] >= kLooksUntilGone;
  gone_[place] = there ? 0 : std::min(gone_[place] + 1, kLooksUntilGone);
  const bool is_gone = gone_[place] >= kLooksUntilGone;
  if (is_gone == was_gone) return;
  const std::string& path = files_[place].path;
  say(is_gone ? fmt::format("the model's file {} is gone or is no longer a regular file; the model "
                            "read from it is still shown, and a restart would fail",
                            path)
              : fmt::format("the model's file {} is there again", path));
}

std::optional<ReadyModel> ModelWatch::take() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || ready_.empty()) return std::nullopt;
  ReadyModel first = std::move(ready_.front());
  ready_.erase(ready_.begin());
  return first;
}

void ModelWatch::say(std::string sentence) {
  const std::lock_guard lock(mutex_);
  events_.push_back(std::move(sentence));
}

std::vector<std::string> ModelWatch::takeEvents() {
  const std::lock_guard lock(mutex_);
  return std::exchange(events_, {});
}

}  // namespace merlin::wall
