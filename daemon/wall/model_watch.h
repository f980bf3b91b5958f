// ModelWatch: notices that the file of a shown model was replaced, and makes the new one ready on a
// thread of its own; the wall takes it between two frames.
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

// When a file that has changed is whole: it has stayed the same for a second, since a copy by `cp`
// is written for as long as it takes. Thread-bound.
class ReplacedFile {
 public:
  explicit ReplacedFile(FileStamp shown) : shown_(shown), seen_(shown) {}

  // Takes the stamp of the file that is there now, or nothing if there is none. Returns true if a
  // file is to be read: it differs from the last one for which this returned true, and has been
  // unchanged for kStable.
  bool look(const std::optional<FileStamp>& found, Timestamp now);

  static constexpr Duration kStable = std::chrono::seconds(1);

 private:
  FileStamp shown_;  // or refused
  FileStamp seen_;
  Timestamp since_{};
};

// A model and its content, ready to be attached to the wall's drawing contexts.
struct ReadyModel {
  std::size_t place = 0;
  std::string path;
  std::unique_ptr<const render::Dendrogram> model;  // the content borrows it
  std::unique_ptr<render::Content> content;
};

// take() and say() are for the wall's thread, takeEvents() is for any.
class ModelWatch {
 public:
  struct Watched {
    std::string path;
    FileStamp shown;
  };
  // Errors: why the file cannot be shown. Called on the thread of its own.
  using Make = std::function<Result<ReadyModel>(std::size_t place, const std::string& path)>;

  // The files by place. `watch` and `clock` outlive this.
  ModelWatch(std::vector<Watched> files, Make make, ThreadWatch& watch, const Clock& clock);
  ~ModelWatch() { thread_.stop(); }
  ModelWatch(const ModelWatch&) = delete;
  ModelWatch& operator=(const ModelWatch&) = delete;

  // One that is ready, if any. Never waits for the thread's work.
  std::optional<ReadyModel> take();
  void say(std::string sentence);
  // Events since the last call, one sentence each.
  std::vector<std::string> takeEvents();

 private:
  void run(const std::stop_token& stop, Progress& progress);
  void lookAt(std::size_t place, Progress& progress);
  void tellWhetherThere(std::size_t place, bool there);

  std::vector<Watched> files_;
  std::vector<ReplacedFile> replaced_;
  std::vector<int> gone_;  // looks in a row that found no file, by place
  Make make_;
  const Clock& clock_;
  std::mutex mutex_;  // of the next two
  std::vector<ReadyModel> ready_;
  std::vector<std::string> events_;
  WatchedThread thread_;
};

}  // namespace merlin::wall
