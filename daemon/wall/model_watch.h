// ModelWatch: notices that the file of a shown model was replaced, and reads and prepares the new
// model on its own thread; the wall takes the model between two frames.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/files.h"
#include "daemon/base/watched_thread.h"
#include "daemon/wall/wall_checks.h"
#include "render/content/model_content.h"

namespace merlin::wall {

// Decides when a changed file is complete: when it has been unchanged for a second, since `cp`
// writes the file gradually under its final name. Thread-bound.
class ReplacedFile {
 public:
  explicit ReplacedFile(FileStamp shown) : shown_(shown), seen_(shown) {}

  // Takes the stamp of the file that is there now, or nothing if there is none. Returns true if a
  // file is to be read: it differs from the last one for which this returned true, and has been
  // unchanged for kStable.
  bool look(const std::optional<FileStamp>& found, Timestamp now);

  static constexpr Duration kStable = std::chrono::seconds(1);

 private:
  FileStamp shown_;  // stamp of the file that is shown, or that was tried and refused
  FileStamp seen_;
  Timestamp since_{};
};

// A model and its content, ready to be attached to the wall's drawing contexts.
struct ReadyModel {
  std::size_t place = 0;
  std::string path;
  std::unique_ptr<const render::lod::Dendrogram> model;  // the content borrows it
  std::unique_ptr<render::content::Content> content;
};

// take() is for the wall's thread; say() and takeEvents() are thread-safe.
class ModelWatch {
 public:
  struct Watched {
    std::string path;
    FileStamp shown;
  };
  // Reads and prepares a model; called on the watch's own thread. Errors: why the file cannot be
  // shown.
  using Make = std::function<Result<ReadyModel>(std::size_t place, const std::string& path)>;

  // `files`: by place, i.e. the content's index. `watch` and `clock` must outlive this object.
  ModelWatch(std::vector<Watched> files, Make make, ThreadWatch& watch, const Clock& clock);
  ~ModelWatch() { thread_.stop(); }
  ModelWatch(const ModelWatch&) = delete;
  ModelWatch& operator=(const ModelWatch&) = delete;

  // Returns a model that is ready, if there is one. Never waits for the watch's thread.
  std::optional<ReadyModel> take();
  // Adds an event.
  void say(std::string sentence);
  // Returns the events since the last call, one sentence each.
  std::vector<std::string> takeEvents();

 private:
  void run(const std::stop_token& stop, Progress& progress);
  void lookAt(std::size_t place, Progress& progress);
  void tellWhetherThere(std::size_t place, bool there);

  std::vector<Watched> files_;
  std::vector<ReplacedFile> replaced_;
  std::vector<int> gone_;  // number of checks in a row that found no file, by place
  Make make_;
  const Clock& clock_;
  std::mutex mutex_;  // protects the next two members
  std::vector<ReadyModel> ready_;
  std::vector<std::string> events_;
  WatchedThread thread_;
};

}  // namespace merlin::wall
