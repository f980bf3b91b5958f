// WindowLink: hands pictures to a separate program, which shows them in a window on a desktop.
//
// The window belongs to the program merlin-window, because the libraries of a desktop end their
// process when the X server goes away, handle signals and may wait without limit. A thread of this
// class starts the program, and if it ends starts it again, at most once every kRetry.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "daemon/base/clock.h"
#include "daemon/base/panel_pointer.h"
#include "daemon/base/unique_fd.h"
#include "daemon/base/watched_thread.h"
#include "render/out/window/picture_slots.h"
#include "render/out/window/settings.h"
#include "render/out/window/window_process.h"

namespace merlin::render::out {

// Functions of merlind that a person at a window can cause. Called on the threads of the outputs.
struct WindowActs {
  // Executes a command of daemon/base/commands.h. Errors: why it was not executed.
  std::function<Result<std::string>(const std::string& name, const std::string& argument)> command =
      [](const std::string&, const std::string&) -> Result<std::string> { return std::string(); };
  // Stops merlind. `why`: a sentence for the log.
  std::function<void(const std::string& why)> stop = [](const std::string&) {};
  // Where the window's picture shows the operator's panel; nothing: it does not.
  std::optional<PanelPointer::Place> panel{};
};

// fault() and isClosed() are thread-safe; show() is called by one thread only.
class WindowLink {
 public:
  static constexpr Duration kRetry = std::chrono::seconds(1);
  // A window that has not taken a frame for kSlow is unhealthy; after kStuck its program is killed
  // and started again.
  static constexpr Duration kSlow = std::chrono::seconds(2);
  static constexpr Duration kStuck = std::chrono::seconds(10);

  // `program`: path of merlin-window. `watch` and `clock` outlive this object.
  WindowLink(WindowSettings settings, WindowActs acts, std::string program, ThreadWatch& watch,
             const Clock& clock);
  ~WindowLink();
  WindowLink(const WindowLink&) = delete;
  WindowLink& operator=(const WindowLink&) = delete;

  // Copies a picture, RGBA, rows from top to bottom, of the same size each time; takes bounded
  // time. Returns whether a window will show it: false if none is open yet, or if it takes the
  // place of a picture that the window has not fetched. Errors: kClosed (see isClosed()); kIo
  // (fault(), or no memory for the pictures).
  Result<bool> show(int width, int height, std::span<const std::uint8_t> pixels);

  // Returns why there is no window, or why it shows nothing; empty if no fault is known.
  std::string fault() const;
  // Returns true once a person has closed the window; it then stays closed.
  bool isClosed() const;

 private:
  WindowForm form() const;
  void work(const std::stop_token& stop, Progress& progress);
  void start(Timestamp now);
  void await();
  void takeEvents();
  void take(const WindowEvent& event);
  void execute(std::string_view command) const;
  void sendNewest();
  void checkIsAlive(Timestamp now);
  void fail(const std::string& why);
  void wake() const;

  WindowSettings settings_;
  WindowActs acts_;
  std::string program_path_;
  const Clock& clock_;
  UniqueFd wake_;  // an eventfd that ends await()

  mutable std::mutex mutex_;           // never held while pixels are copied or the system is called
  std::optional<PictureSlots> slots_;  // from the first frame on; slots are written without mutex_
  std::uint32_t newest_ = 0;           // slot of the newest frame
  std::uint32_t in_flight_ = 0;        // slot of the frame that the program was sent last
  std::uint64_t frames_ = 0, sent_ = 0;  // number of the newest frame; of the one sent last
  bool opened_ = false;                  // the program has reported that its window is open
  bool closed_ = false;                  // a person closed it
  std::string fault_;                    // empty: none is known

  // Used by the thread only.
  std::unique_ptr<WindowProcess> process_;
  Timestamp next_start_{};
  std::optional<Timestamp> owed_since_;  // since when an answer of the program is awaited
  WatchedThread thread_;
};

}  // namespace merlin::render::out
