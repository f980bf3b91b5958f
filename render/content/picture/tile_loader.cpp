#include "render/content/picture/tile_loader.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <fmt/format.h>

namespace merlin::render::content {
namespace {

constexpr std::size_t kMostFaults = 100;         // sentences that wait for takeFaults()
constexpr std::size_t kMostUnreadable = 65'536;  // tiles of one picture that are remembered

}  // namespace

TileLoader::TileLoader(ThreadWatch& watch, const Clock& clock) : clock_(clock) {
  thread_ = WatchedThread(watch, "picture tiles",
                          [this](const std::stop_token& s, Progress& p) { run(s, p); });
}

void TileLoader::ask(const std::shared_ptr<const Picture>& picture,
                     std::span<const image::TilePlace> places) {
  const std::lock_guard lock(mutex_);
  if (std::exchange(picture_, picture) != picture) {
    unreadable_.clear();
    said_ = false;
    loaded_.clear();
    loading_.reset();
  }
  places_.clear();
  again_.clear();
  for (const image::TilePlace& place : places) {
    const bool waits =
        std::ranges::any_of(loaded_, [&](const LoadedTile& tile) { return tile.place == place; });
    if (waits || place == loading_) continue;
    if (unreadable_.count(place) > 0)
      again_.push_back(place);
    else
      places_.push_back(place);
  }
  if (hasWork()) changed_.notify_one();
}

std::optional<LoadedTile> TileLoader::take() {
  const std::lock_guard lock(mutex_);
  if (loaded_.empty()) return std::nullopt;
  LoadedTile tile = std::move(loaded_.front());
  loaded_.pop_front();
  if (hasWork()) changed_.notify_one();
  return tile;
}

bool TileLoader::hasLoaded() const {
  const std::lock_guard lock(mutex_);
  return !loaded_.empty();
}

bool TileLoader::isLoading() const {
  const std::lock_guard lock(mutex_);
  return !places_.empty() || loading_;
}

std::vector<std::string> TileLoader::takeFaults() {
  const std::lock_guard lock(mutex_);
  return std::exchange(faults_, {});
}

void TileLoader::run(const std::stop_token& stop, Progress& progress) {
  giveWay();
  std::optional<image::PyramidReader> reader;
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    changed_.wait_for(lock, stop, std::chrono::milliseconds(500), [&] { return hasWork(); });
    progress.step();
    tryAgain();
    if (hasWork() && !stop.stop_requested()) {
      const Progress::Pause pause(progress);  // a file server may be slow
      load(lock, reader);
    }
  }
}

// Appends unreadable tiles again after kTryAgain. Other tiles that were asked for come first, since
// they may well be readable.
void TileLoader::tryAgain() {
  const Timestamp now = clock_.now();
  std::erase_if(again_, [&](const image::TilePlace& place) {
    const bool due = now - unreadable_[place] >= kTryAgain;
    if (due) places_.push_back(place);
    return due;
  });
}

// Loads the most urgent tile; the lock is released meanwhile. A tile that was asked for by an
// earlier call is still taken: it costs the wall nothing.
void TileLoader::load(std::unique_lock<std::mutex>& lock,
                      std::optional<image::PyramidReader>& reader) {
  const std::shared_ptr<const Picture> picture = picture_;
  const image::TilePlace place = places_.front();
  places_.pop_front();
  loading_ = place;
  lock.unlock();
  LoadedTile tile{picture, place, {}};
  std::string fault;
  try {
    if (!reader || &reader->file() != picture->file.get()) reader.emplace(picture->file);
    const auto read = readPictureTile(*reader, picture->kind, place, tile.pixels);
    if (!read) fault = read.error().what;
  } catch (const std::exception& e) {
    fault = fmt::format("{}: {}", picture->file->name(), e.what());
  }
  lock.lock();
  if (picture_ != picture) return;
  loading_.reset();
  if (fault.empty()) {
    unreadable_.erase(place);
    loaded_.push_back(std::move(tile));
    return;
  }
  // The wall draws without this tile. It is notified only once, since each notice makes it draw a
  // frame.
  if (unreadable_.count(place) == 0) loaded_.push_back({picture, place, {}});
  noteFault(place, fault);
  if (unreadable_.count(place) > 0) again_.push_back(place);
}

void TileLoader::noteFault(const image::TilePlace& place, const std::string& what) {
  if (!std::exchange(said_, true) && faults_.size() < kMostFaults) {
    faults_.push_back(fmt::format(
        "a part of the picture cannot be read and is shown coarser ({}); import it again", what));
  }
  if (unreadable_.size() < kMostUnreadable || unreadable_.count(place) > 0)
    unreadable_[place] = clock_.now();
}

}  // namespace merlin::render::content
