// TileLoader: reads and decodes tiles on request, on its own thread.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/watched_thread.h"
#include "render/content/picture/picture.h"

namespace merlin::render::content {

struct LoadedTile {
  std::shared_ptr<const Picture> picture;
  image::TilePlace place;
  TilePixels pixels;  // empty: the tile cannot be read
};

// Port (an interface): loads tiles. Called on the wall's thread; never waits.
class TileSource {
 public:
  virtual ~TileSource() = default;

  // Asks for tiles of a picture, the most urgent first, instead of those that were asked for
  // before. A tile that could not be read is tried again after some time if it is still asked for.
  virtual void ask(const std::shared_ptr<const Picture>& picture,
                   std::span<const image::TilePlace> places) = 0;
  // Returns a tile that was loaded, if there is one. It may be one that nobody asks for any more.
  virtual std::optional<LoadedTile> take() = 0;
  // Returns whether take() would return a tile.
  virtual bool hasLoaded() const = 0;
  // Returns whether a tile that was asked for is still to be loaded, i.e. is neither loaded nor
  // found to be unreadable yet.
  virtual bool isLoading() const = 0;
};

// Thread-bound to the wall's thread, except takeFaults(), which is thread-safe.
class TileLoader final : public TileSource {
 public:
  // `watch` and `clock` must outlive this object. Memory: kMostLoaded tiles, and a reader.
  TileLoader(ThreadWatch& watch, const Clock& clock);
  ~TileLoader() override { thread_.stop(); }
  TileLoader(const TileLoader&) = delete;
  TileLoader& operator=(const TileLoader&) = delete;

  void ask(const std::shared_ptr<const Picture>& picture,
           std::span<const image::TilePlace> places) override;
  std::optional<LoadedTile> take() override;
  bool hasLoaded() const override;
  bool isLoading() const override;

  // Returns a sentence for each picture of which a tile could not be read since the last call.
  std::vector<std::string> takeFaults();

  static constexpr std::size_t kMostLoaded = 32;  // tiles that wait for take()
  // After this time an unreadable tile is tried again, so that no part of a picture stays coarse
  // because a file server did not answer for a moment.
  static constexpr Duration kTryAgain = std::chrono::seconds(10);

 private:
  void run(const std::stop_token& stop, Progress& progress);
  bool hasWork() const { return !places_.empty() && loaded_.size() < kMostLoaded; }
  void load(std::unique_lock<std::mutex>& lock, std::optional<image::PyramidReader>& reader);
  void tryAgain();
  void noteFault(const image::TilePlace& place, const std::string& what);

  const Clock& clock_;
  mutable std::mutex mutex_;  // protects all up to thread_
  std::condition_variable_any changed_;
  std::shared_ptr<const Picture> picture_;
  std::deque<image::TilePlace> places_;      // still to load
  std::vector<image::TilePlace> again_;      // asked for, and to be tried again
  std::optional<image::TilePlace> loading_;  // the tile of picture_ that the thread loads now
  std::deque<LoadedTile> loaded_;
  std::map<image::TilePlace, Timestamp> unreadable_;  // of picture_: when each was tried last
  bool said_ = false;  // a tile of picture_ was reported as unreadable
  std::vector<std::string> faults_;
  WatchedThread thread_;
};

}  // namespace merlin::render::content
