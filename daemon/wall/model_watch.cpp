#include "daemon/wall/model_watch.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <utility>

#include <fmt/format.h>

namespace merlin::wall {
namespace {

constexpr std::chrono::seconds kCheckPeriod{1};
constexpr int kChecksUntilGone = 3;

}  // namespace

bool ReplacedFile::look(const std::optional<FileStamp>& found, Timestamp now) {
  if (!found) return false;  // being renamed, or removed: the content shown stays
  if (*found != seen_) {
    seen_ = *found;
    since_ = now;
  }
  if (seen_ == shown_ || now - since_ < kStable) return false;
  shown_ = seen_;
  return true;
}

ModelWatch::ModelWatch(std::vector<Watched> files, Make make, MissingContents& missing,
                       ThreadWatch& watch, const Clock& clock, Duration try_again)
    : files_(std::move(files)),
      make_(std::move(make)),
      missing_(missing),
      clock_(clock),
      try_again_(try_again) {
  for (const Watched& file : files_) {
    replaced_.emplace_back(file.shown);
    if (!file.fault.empty()) {
      report(faultEvent(
          fmt::format("{} is left out until it can be read: {}", file.path, file.fault)));
    }
    if (!file.left_out.empty()) noteLeftOut(file.path, file.left_out);
  }
  gone_.resize(files_.size());
  tried_.resize(files_.size(), clock_.now());
  thread_ = WatchedThread(watch, "contents",
                          [this](const std::stop_token& s, Progress& p) { run(s, p); });
}

void ModelWatch::run(const std::stop_token& stop, Progress& progress) {
  giveWay();
  while (!stop.stop_requested()) {
    readAsked(progress);
    followOffered();
    for (std::size_t place = 0; place < files_.size(); ++place) lookAt(place, progress);
    progress.step();
    std::unique_lock lock(mutex_);
    asked_changed_.wait_for(lock, stop, kCheckPeriod, [this] { return !asked_.empty(); });
  }
}

void ModelWatch::ask(Read read, std::uint32_t request) {
  ask(Asked{std::move(read), request, kNoPlace});
}

void ModelWatch::askForSlide(Read read, std::size_t place) {
  ask(Asked{std::move(read), 0, place});
}

void ModelWatch::ask(Asked asked) {
  const std::lock_guard lock(mutex_);
  asked_.push_back(std::move(asked));
  asked_changed_.notify_one();
}

// Reports the pictures in a folder of slides that are not shown, once and again only when they
// change, because the folder is read again for each slide.
void ModelWatch::noteLeftOut(const std::string& slide, const std::string& left_out) {
  const std::string folder = std::filesystem::path(slide).parent_path().string();
  const std::lock_guard lock(mutex_);
  if (std::exchange(left_out_[folder], left_out) != left_out && !left_out.empty())
    events_.push_back(faultEvent(left_out));
}

void ModelWatch::reportSkipped(const std::vector<std::string>& skipped) {
  constexpr Duration kSaidAgain = std::chrono::hours(1);
  const Timestamp now = clock_.now();
  const std::lock_guard lock(mutex_);
  std::erase_if(skipped_, [&](const auto& said) { return now - said.second >= kSaidAgain; });
  for (const std::string& why : skipped) {
    if (skipped_.try_emplace(why, now).second) events_.push_back(faultEvent(why));
  }
}

void ModelWatch::offer(ReadyModel ready) {
  if (ready.is_slide) noteLeftOut(ready.path, ready.left_out);
  const std::lock_guard lock(mutex_);
  offered_.emplace_back(ready.place,
                        Watched{ready.path, ready.stamp, ready.picture ? "picture" : "model"});
  // Removes an older content of this place that the wall has not taken yet.
  std::erase_if(ready_, [&](const ReadyModel& r) { return r.place == ready.place; });
  ready_.push_back(std::move(ready));
}

void ModelWatch::readAsked(Progress& progress) {
  for (;;) {
    Asked asked;
    {
      const std::lock_guard lock(mutex_);
      if (asked_.empty()) return;
      asked = std::move(asked_.front());
      asked_.erase(asked_.begin());
    }
    const Progress::Pause pause(progress);
    Result<ReadyModel> ready = Error{Errc::kNoMemory, "there is not enough memory"};
    try {
      ready = asked.read();
    } catch (const std::bad_alloc&) {  // `ready` says so
    } catch (const std::exception& e) {
      ready = Error{Errc::kIo, e.what()};
    }
    if (ready) {
      offer(*std::move(ready));
      continue;
    }
    report(faultEvent(
        fmt::format("the content that was asked for cannot be shown: {}", ready.error().what)));
    ReadyModel nothing;
    nothing.place = asked.place;
    nothing.is_slide = asked.place != kNoPlace;
    nothing.request = asked.request;
    nothing.refused = ready.error().what;
    const std::lock_guard lock(mutex_);
    ready_.push_back(std::move(nothing));
  }
}

// Starts to watch the files of the contents that were passed to offer().
void ModelWatch::followOffered() {
  std::vector<std::pair<std::size_t, Watched>> offered;
  {
    const std::lock_guard lock(mutex_);
    offered = std::exchange(offered_, {});
  }
  for (auto& [place, file] : offered) {
    replaced_[place] = ReplacedFile(file.shown);
    gone_[place] = 0;
    files_[place] = std::move(file);
  }
}

// Checks the file of a place, and reads it if it is to be read. A replaced file that cannot be
// shown is tried again only after it has changed again.
void ModelWatch::lookAt(std::size_t place, Progress& progress) {
  const std::string& path = files_[place].path;
  if (path.empty()) return;
  const Progress::Pause pause(progress);  // a file server may be slow, and a model may be large
  const bool missing = !files_[place].fault.empty();
  const auto found = missing ? fileOrFolderStamp(path) : fileStamp(path);
  if (!missing) noteWhetherThere(place, found.has_value());
  const Timestamp now = clock_.now();
  const bool due = missing && found && now - tried_[place] >= try_again_;
  if (!replaced_[place].look(found, now) && !due) return;
  tried_[place] = now;
  Result<ReadyModel> ready = Error{Errc::kNoMemory, path + ": there is not enough memory"};
  try {
    ready = make_(place, path);
  } catch (const std::bad_alloc&) {  // `ready` says so
  } catch (const std::exception& e) {
    ready = Error{Errc::kIo, fmt::format("{}: {}", path, e.what())};
  }
  handOver(place, std::move(ready));
}

// Passes on a content that was read because the file of a place has changed, or reports why it
// cannot be shown.
void ModelWatch::handOver(std::size_t place, Result<ReadyModel> ready) {
  const Watched& file = files_[place];
  const bool missing = !file.fault.empty();
  if (missing && ready) return offer(*std::move(ready));
  if (missing) {
    if (missing_.faultOf(place) != ready.error().what)
      report(faultEvent(fmt::format("{} is still left out: {}", file.path, ready.error().what)));
    return missing_.set(place, ready.error().what);
  }
  if (!ready) {
    return report(faultEvent(
        fmt::format("the {0}'s file was replaced by one that cannot be shown ({1}); the {0} "
                    "that was read before stays",
                    file.what, ready.error().what)));
  }
  ready->was_replaced = true;
  const std::lock_guard lock(mutex_);
  // Removes an older content of this place that the wall has not taken yet; it is freed here, not
  // on the wall's thread.
  std::erase_if(ready_, [&](const ReadyModel& r) { return r.place == place; });
  ready_.push_back(*std::move(ready));
}

// Reports that a file is missing, or is there again. To be called once per check. A missing file is
// reported only after kChecksUntilGone checks in a row, since a file that is being replaced may be
// missing for a moment.
void ModelWatch::noteWhetherThere(std::size_t place, bool there) {
  const bool was_gone = gone_[place] >= kChecksUntilGone;
  gone_[place] = there ? 0 : std::min(gone_[place] + 1, kChecksUntilGone);
  const bool is_gone = gone_[place] >= kChecksUntilGone;
  if (is_gone == was_gone) return;
  const std::string& path = files_[place].path;
  const std::string& what = files_[place].what;
  report(is_gone ? faultEvent(fmt::format(
                       "the {0}'s file {1} is gone or is no longer a regular file; the {0} "
                       "read from it is still shown, and a restart would not find it",
                       what, path))
                 : newsEvent(fmt::format("the {}'s file {} is there again", what, path)));
}

std::optional<ReadyModel> ModelWatch::take() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || ready_.empty()) return std::nullopt;
  ReadyModel first = std::move(ready_.front());
  ready_.erase(ready_.begin());
  return first;
}

void ModelWatch::report(Event event) {
  const std::lock_guard lock(mutex_);
  events_.push_back(std::move(event));
}

std::vector<Event> ModelWatch::takeEvents() {
  const std::lock_guard lock(mutex_);
  return std::exchange(events_, {});
}

}  // namespace merlin::wall
