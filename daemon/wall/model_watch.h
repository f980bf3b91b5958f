// ModelWatch: notices that the file of a shown content was replaced, and reads and prepares the new
// content on its own thread; the wall takes it between two frames. It also reads what somebody asks
// for: the next slide, or a file that is not in the configuration.
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/event_kinds.h"
#include "daemon/base/files.h"
#include "daemon/base/watched_thread.h"
#include "daemon/wall/missing_contents.h"
#include "render/content/model_content.h"
#include "render/content/picture/picture.h"

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

// A content that is ready to be shown: a model with its content, to be attached to the wall's
// drawing contexts, or a picture.
struct ReadyModel {
  std::size_t place = 0;
  std::string path;
  std::unique_ptr<const render::lod::Dendrogram> model;  // the content borrows it
  std::unique_ptr<render::content::Content> content;
  std::shared_ptr<const render::content::Picture> picture{};  // for a picture, instead of these two
  std::string name{};
  FileStamp stamp{};
  bool is_slide = false, is_first_slide = false, is_last_slide = false;
  std::string left_out{};     // see WallContent
  bool asked_for = false;     // to be shown now, from its start view
  bool was_replaced = false;  // its file was replaced by another one
  std::uint32_t request = 0;  // of WallRole::show(); 0: none
  // Why there is nothing to show; then only place, is_slide and request are valid besides.
  std::string refused{};
};

// take() is for the wall's thread; all others are thread-safe.
class ModelWatch {
 public:
  struct Watched {
    std::string path;  // empty: none yet
    FileStamp shown;
    std::string what = "model";  // what the file holds, for messages
    // Why nothing of it is shown yet; then `path` may be a folder, and `shown` is the stamp of what
    // was tried. Empty: it is shown.
    std::string fault{};
    std::string left_out{};  // see WallContent
  };
  // Reads and prepares the file of a place again; called on the watch's own thread. Errors: why the
  // file cannot be shown.
  using Make = std::function<Result<ReadyModel>(std::size_t place, const std::string& path)>;
  // Reads and prepares a content that was asked for. Errors as above.
  using Read = std::function<Result<ReadyModel>()>;

  // `files`: by place, i.e. the content's index. Those that have a fault are tried again when they
  // have changed, and every `try_again`, since the stamp of a folder tells nothing of a file that
  // is still being written there. `missing`, `watch` and `clock` must outlive this object.
  ModelWatch(std::vector<Watched> files, Make make, MissingContents& missing, ThreadWatch& watch,
             const Clock& clock, Duration try_again = std::chrono::seconds(10));
  ~ModelWatch() { thread_.stop(); }
  ModelWatch(const ModelWatch&) = delete;
  ModelWatch& operator=(const ModelWatch&) = delete;

  // Returns a content that is ready, if there is one. Never waits for the watch's thread.
  std::optional<ReadyModel> take();
  // Calls `read` on the watch's thread; take() then returns its result. An error becomes an event;
  // take() then returns a refused content with the number of the request, or with the place whose
  // next slide was asked for.
  void ask(Read read, std::uint32_t request = 0);
  void askForSlide(Read read, std::size_t place);
  // Adds a content that is ready, for take().
  void offer(ReadyModel ready);
  // Adds an event.
  void report(Event event);
  // Adds an event for each slide that was left out; `skipped` has a sentence for each. The same
  // sentence is repeated at most once an hour, since slides come round.
  void reportSkipped(const std::vector<std::string>& skipped);
  // Returns the events since the last call, one sentence each.
  std::vector<Event> takeEvents();

 private:
  void run(const std::stop_token& stop, Progress& progress);
  void lookAt(std::size_t place, Progress& progress);
  void handOver(std::size_t place, Result<ReadyModel> ready);
  void readAsked(Progress& progress);
  void followOffered();
  void noteWhetherThere(std::size_t place, bool there);
  void noteLeftOut(const std::string& slide, const std::string& left_out);

  std::vector<Watched> files_;
  std::vector<ReplacedFile> replaced_;
  std::vector<int> gone_;         // number of checks in a row that found no file, by place
  std::vector<Timestamp> tried_;  // when a missing one was read last, by place
  Make make_;
  MissingContents& missing_;
  const Clock& clock_;
  const Duration try_again_;
  // Stands for the place of a content that has none, so that it is not mistaken for an outdated
  // one.
  static constexpr std::size_t kNoPlace = ~std::size_t{0};
  struct Asked {
    Read read;
    std::uint32_t request = 0;
    std::size_t place = kNoPlace;
  };
  void ask(Asked asked);
  std::mutex mutex_;  // protects all up to thread_
  std::condition_variable_any asked_changed_;
  std::vector<ReadyModel> ready_;
  std::vector<Event> events_;
  std::map<std::string, std::string> left_out_;  // by folder of slides: what was said last
  std::map<std::string, Timestamp> skipped_;     // when each sentence of reportSkipped() was said
  std::vector<Asked> asked_;
  std::vector<std::pair<std::size_t, Watched>> offered_;  // files to look at from now on, by place
  WatchedThread thread_;
};

}  // namespace merlin::wall
