// CursesScreen: shows a CellGrid on the terminal and reads keys, through ncurses.
#pragma once

#include <optional>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"
#include "daemon/cli/watch/cell_grid.h"
#include "daemon/cli/watch/watch_view.h"

namespace merlin::cli {

// Only one object may exist at a time; thread-bound. While it exists, the terminal shows another
// screen and passes each key on at once; the destructor restores the terminal. Blocks the signals
// of stopSignals(); key() reports them as kQuit.
class CursesScreen {
 public:
  // Returns whether standard input and output are a terminal whose type (TERM) is set and not
  // "dumb".
  static bool isPossible();

  CursesScreen();
  ~CursesScreen();
  CursesScreen(const CursesScreen&) = delete;
  CursesScreen& operator=(const CursesScreen&) = delete;

  // Returns whether the constructor could use the terminal. Errors: kUnsupported (ncurses does not
  // know the terminal's type). All other functions except hasUnicode() require that opened()
  // returned Ok.
  Result<Ok> opened() const;

  ScreenSize size() const;
  // Returns whether the locale uses UTF-8; if not, characters outside ASCII are shown as '?'.
  bool hasUnicode() const noexcept { return unicode_; }
  // Shows the grid; only changed cells are sent to the terminal.
  void show(const CellGrid& grid);

  enum class Key { kNone, kOther, kQuit, kResized };
  // Waits up to `timeout_ms` for a key. Returns kNone if there was none, kResized if the size of
  // the terminal has changed, and kQuit after 'q', Ctrl-C or a signal of stopSignals(), or if the
  // terminal is gone.
  Key key(int timeout_ms);

 private:
  UniqueFd signals_;
  void* screen_ = nullptr;  // a SCREEN of ncurses, whose header only the source file includes
  bool unicode_ = false, colours_ = false;
};

}  // namespace merlin::cli
