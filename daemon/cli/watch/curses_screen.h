// CursesScreen: shows a CellGrid on the terminal and reads its keys, by ncurses.
#pragma once

#include <optional>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"
#include "daemon/cli/watch/cell_grid.h"
#include "daemon/cli/watch/watch_view.h"

namespace merlin::cli {

// Only one may exist at a time; thread-bound. While it exists, the terminal shows another screen
// and passes each key on at once; afterwards it is restored. Blocks the signals of stopSignals();
// key() reports them as kQuit.
class CursesScreen {
 public:
  // Whether standard input and output are a terminal that can place text anywhere: false if TERM is
  // unset or "dumb".
  static bool isPossible();

  CursesScreen();
  ~CursesScreen();
  CursesScreen(const CursesScreen&) = delete;
  CursesScreen& operator=(const CursesScreen&) = delete;

  // Ok, or why the terminal cannot be used (ncurses does not know its type). REQUIRES for all
  // functions that follow: it returned Ok.
  Result<Ok> opened() const;

  ScreenSize size() const;
  // Whether the locale is one of UTF-8; otherwise characters outside ASCII are shown as '?'.
  bool hasUnicode() const noexcept { return unicode_; }
  // Shows the grid; only cells that changed are sent to the terminal.
  void show(const CellGrid& grid);

  enum class Key { kNone, kOther, kQuit, kResized };
  // Waits for a key, `timeout_ms` at most. kQuit: 'q', Ctrl-C, a signal that ends the program, or
  // the terminal is gone.
  Key key(int timeout_ms);

 private:
  UniqueFd signals_;
  void* screen_ = nullptr;  // ncurses' own SCREEN, whose header only the source includes
  bool unicode_ = false, colours_ = false;
};

}  // namespace merlin::cli
