#include "daemon/state/state_keeper.h"

#include <chrono>
#include <utility>

#include <fmt/format.h>

namespace merlin::state {
namespace {

constexpr auto kStep = std::chrono::milliseconds(500);

Result<State> parsed(const Result<std::string>& text, const std::string& name) {
  if (!text) return text.error();
  return parseState(*text, name);
}

// Returns the part of a message that says what is used instead of a damaged state file. `previous`:
// the previous state, or the reason why it cannot be used.
const char* outcomeOf(const Result<State>& previous) {
  if (previous) return "the previous state is used";
  if (previous.error().code == Errc::kNotFound)
    return "there is no previous one: the configuration's values are used";
  if (previous.error().code == Errc::kMalformed)
    return "the previous one is damaged too: the configuration's values are used";
  return "the previous one cannot be used either: the configuration's values are used";
}

}  // namespace

StateKeeper::StateKeeper(std::unique_ptr<StateFiles> files, ThreadWatch& watch, Duration try_again)
    : files_(std::move(files)), try_again_(try_again) {
  load();
  if (!may_save_) return;
  thread_ = WatchedThread(watch, "state", [this](const std::stop_token& stop, Progress& progress) {
    loop(stop, progress);
  });
}

StateKeeper::~StateKeeper() { thread_.stop(); }

void StateKeeper::load() {
  if (!files_) {
    may_save_ = false;
    fault_ = "there is no folder for the state file: set /state_file";
    return;
  }
  auto last = parsed(files_->read(), files_->name());
  if (last) {
    state_ = *std::move(last);
    return;
  }
  switch (last.error().code) {
    case Errc::kMalformed: return loadPrevious(last.error());
    case Errc::kNotFound:
      // The first start has no previous state either. If merlind ended between putAside() and the
      // next write(), only the previous state exists.
      if (auto previous = parsed(files_->readPrevious(), files_->name()); previous) {
        state_ = *std::move(previous);
        notices_.push_back(
            fmt::format("{} is missing: the previous state is used", files_->name()));
      }
      return;
    default: break;
  }
  may_save_ = false;
  fault_ = fmt::format(
      "{}; the file is left alone: the configuration's values are used, and changes are not "
      "saved",
      last.error().what);
}

void StateKeeper::loadPrevious(const Error& why) {
  auto previous = parsed(files_->readPrevious(), files_->name() + ".previous");
  const char* const outcome = outcomeOf(previous);
  if (previous) state_ = *std::move(previous);
  const auto aside = files_->putAside();
  notices_.push_back(
      fmt::format("the state file is damaged: {}; {}; {}", why.what, outcome,
                  aside ? fmt::format("the damaged file is {}.damaged now", files_->name())
                        : aside.error().what));
}

State StateKeeper::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

void StateKeeper::change(const std::function<void(State&)>& edit) {
  const std::lock_guard lock(mutex_);
  edit(state_);
  unsaved_ = may_save_;
  wake_.notify_one();
}

std::string StateKeeper::fault() const {
  const std::lock_guard lock(mutex_);
  return fault_;
}

std::vector<std::string> StateKeeper::takeNotices() {
  const std::lock_guard lock(mutex_);
  return std::exchange(notices_, {});
}

void StateKeeper::addNotice(std::string sentence) {
  const std::lock_guard lock(mutex_);
  notices_.push_back(std::move(sentence));
}

void StateKeeper::settle() {
  std::unique_lock lock(mutex_);
  settled_.wait(lock, [&] { return !saving_ && (!unsaved_ || !fault_.empty()); });
}

void StateKeeper::save() {
  std::string text;
  {
    const std::lock_guard lock(mutex_);
    text = stateText(state_);
    unsaved_ = false;
    saving_ = true;
  }
  const auto written = files_->write(text);
  const std::lock_guard lock(mutex_);
  saving_ = false;
  unsaved_ = unsaved_ || !written;
  fault_ = written ? std::string()
                   : fmt::format("{}; saving is tried again every {:.3g} s", written.error().what,
                                 toSeconds(try_again_));
  settled_.notify_all();
}

void StateKeeper::loop(const std::stop_token& stop, Progress& progress) {
  giveWay();
  auto tried = std::chrono::steady_clock::now() - try_again_;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      const auto due = [&] {
        return unsaved_ &&
               (fault_.empty() || std::chrono::steady_clock::now() - tried >= try_again_);
      };
      wake_.wait_for(lock, stop, kStep, due);
      progress.step();
      if (stop.stop_requested() && !unsaved_) return;
      if (!due() && !stop.stop_requested()) continue;
    }
    tried = std::chrono::steady_clock::now();
    const bool last = stop.stop_requested();
    const Progress::Pause pause(progress);  // writing to a disk may take long
    save();
    if (last) return;  // after the stop request, saving is tried only once
  }
}

}  // namespace merlin::state
