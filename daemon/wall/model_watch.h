// ModelWatch: notices that the file of a content was replaced, and reads and prepares the new
// content on its own thread; the wall takes it between two frames. It also reads what a person
// requests: the next slide, or a file that is not in the configuration.
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

// Decides when a changed file is complete: when it has not changed for a second, since `cp` writes
// a file gradually under its final name. Thread-bound.
class ReplacedFile {
 public:
  explicit ReplacedFile(FileStamp shown) : shown_(shown), seen_(shown) {}

  // Returns true if the file is to be read: it differs from the file that was read last, and has
  // not changed for kStable. `found`: stamp of the file at `now`; nothing if there is none.
  bool look(const std::optional<FileStamp>& found, Timestamp now);

  static constexpr Duration kStable = std::chrono::seconds(1);

 private:
  FileStamp shown_;  // stamp of the file that was read last, even if it cannot be shown
  FileStamp seen_;
  Timestamp since_{};
};

// A content that is ready to be shown: a model with its Content, which the wall's thread attaches
// to its drawing contexts, or a picture.
struct ReadyModel {
  std::size_t place = 0;
  std::string path;
  std::unique_ptr<const render::lod::Dendrogram> model;  // used by `content`
  std::unique_ptr<render::content::Content> content;
  // For a picture, instead of `model` and `content`.
  std::shared_ptr<const render::content::Picture> picture{};
  std::string name{};
  FileStamp stamp{};
  bool is_slide = false, is_first_slide = false, is_last_slide = false;
  std::string left_out{};     // see WallContent
  bool asked_for = false;     // show it now, from its initial view
  bool was_replaced = false;  // it was read because its file was replaced
  std::uint32_t request = 0;  // number of the request (ContentRequests); 0: none
  // Why the content cannot be shown; empty: it can. If not empty, only place (for slides), is_slide
  // and request are valid too.
  std::string refused{};
};

// take() is for the wall's thread; all other functions are thread-safe.
class ModelWatch {
 public:
  struct Watched {
    std::string path;  // empty: no file is watched yet
    FileStamp shown;
    std::string what = "model";  // what the file contains, for messages
    // Why the content cannot be shown yet. Then `path` may be a folder, and `shown` is the stamp of
    // the file or folder that was tried. Empty: it is shown.
    std::string fault{};
    std::string left_out{};  // see WallContent
  };
  // Reads and prepares the changed file `path` of a place. Called on the thread of ModelWatch.
  // Errors: the reason why the file cannot be shown.
  using Make = std::function<Result<ReadyModel>(std::size_t place, const std::string& path)>;
  // Reads and prepares a content that was requested. Called on the thread of ModelWatch. Errors:
  // the reason why it cannot be shown.
  using Read = std::function<Result<ReadyModel>()>;

  // `files`: the file of each place, i.e. of each content. Those with a fault are tried again when
  // they have changed, and every `try_again`, since the stamp of a folder does not show that a file
  // in it is still being written. `missing`, `watch` and `clock` must outlive this object.
  ModelWatch(std::vector<Watched> files, Make make, MissingContents& missing, ThreadWatch& watch,
             const Clock& clock, Duration try_again = std::chrono::seconds(10));
  ~ModelWatch() { thread_.stop(); }
  ModelWatch(const ModelWatch&) = delete;
  ModelWatch& operator=(const ModelWatch&) = delete;

  // Returns the next content that is ready; nothing if there is none. Never waits: also returns
  // nothing while another thread holds the lock.
  std::optional<ReadyModel> take();
  // Both call `read` on the thread of ModelWatch; take() returns its result later. An error is
  // reported as an event; take() then returns a refused content with the number of the request
  // (ask()) or with `place`, whose slide was requested (askForSlide()).
  void ask(Read read, std::uint32_t request = 0);
  void askForSlide(Read read, std::size_t place);
  // Adds a content that is ready to those that take() returns, and watches its file from now on.
  void offer(ReadyModel ready);
  // Adds an event to those that takeEvents() returns.
  void report(Event event);
  // Adds an event for each slide that was skipped; `skipped` has a sentence for each of them. The
  // same sentence is reported at most once an hour, since slides are shown again and again.
  void reportSkipped(const std::vector<std::string>& skipped);
  // Returns the events since the last call, each a sentence.
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
  std::vector<int> gone_;         // for each place: number of checks in a row that found no file
  std::vector<Timestamp> tried_;  // for each place: time of the last attempt to read it
  Make make_;
  MissingContents& missing_;
  const Clock& clock_;
  const Duration try_again_;
  // Place of a request that is not for a slide, so that it is equal to no real place.
  static constexpr std::size_t kNoPlace = ~std::size_t{0};
  struct Asked {
    Read read;
    std::uint32_t request = 0;
    std::size_t place = kNoPlace;
  };
  void ask(Asked asked);
  std::mutex mutex_;  // guards all members up to thread_
  std::condition_variable_any asked_changed_;
  std::vector<ReadyModel> ready_;
  std::vector<Event> events_;
  std::map<std::string, std::string> left_out_;  // by folder of slides: last sentence reported
  std::map<std::string, Timestamp> skipped_;     // when each sentence was reported
  std::vector<Asked> asked_;
  // Files to be watched from now on, each with its place.
  std::vector<std::pair<std::size_t, Watched>> offered_;
  WatchedThread thread_;
};

}  // namespace merlin::wall
