#include "daemon/cli/watch/curses_screen.h"

#include <array>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <langinfo.h>
#include <poll.h>
#include <unistd.h>

#define NCURSES_NOMACROS 1  // the macros of ncurses have names such as move and clear
#define NCURSES_WIDECHAR 1
#include <curses.h>

#include "daemon/cli/stop_signals.h"

namespace merlin::cli {
namespace {

// Text colour of each CellStyle; -1: the terminal's default colour.
constexpr std::array<short, 6> kCellColours = {-1,           COLOR_CYAN, COLOR_GREEN,
                                               COLOR_YELLOW, COLOR_RED,  -1};

short pairOf(CellStyle style) { return static_cast<short>(static_cast<int>(style) + 1); }

// Returns the attributes of a style, so that headings and faults differ from other text even
// without colours.
attr_t attributesOf(CellStyle style) {
  switch (style) {
    case CellStyle::kHeading:
    case CellStyle::kBad: return WA_BOLD;
    case CellStyle::kDim: return WA_DIM;
    default: return WA_NORMAL;
  }
}

std::string_view terminalType() {
  const char* const type = std::getenv("TERM");  // NOLINT(concurrency-mt-unsafe): one thread
  return type ? type : "";
}

}  // namespace

bool CursesScreen::isPossible() {
  return ::isatty(STDIN_FILENO) == 1 && ::isatty(STDOUT_FILENO) == 1 && !terminalType().empty() &&
         terminalType() != "dumb";
}

CursesScreen::CursesScreen() : signals_(stopSignals()) {
  std::setlocale(LC_CTYPE, "");  // NOLINT(concurrency-mt-unsafe): before any other thread
  unicode_ = std::string_view(::nl_langinfo(CODESET)) == "UTF-8";  // NOLINT(concurrency-mt-unsafe)
  screen_ = ::newterm(nullptr, stdout, stdin);
  if (!screen_) return;
  ::cbreak();
  ::noecho();
  ::nonl();
  ::curs_set(0);
  ::keypad(stdscr, true);
  ::nodelay(stdscr, true);
  colours_ = ::has_colors() && ::start_color() == OK;
  if (!colours_) return;
  ::use_default_colors();
  for (std::size_t i = 0; i < kCellColours.size(); ++i)
    ::init_pair(pairOf(static_cast<CellStyle>(i)), kCellColours[i], -1);
}

CursesScreen::~CursesScreen() {
  if (!screen_) return;
  ::endwin();
  ::delscreen(static_cast<SCREEN*>(screen_));
}

Result<Ok> CursesScreen::opened() const {
  if (screen_) return Ok{};
  return Error{Errc::kUnsupported,
               fmt::format("the terminal type \"{}\" (the environment's TERM) is not known; use "
                           "merlin watch --lines, which works on any terminal",
                           terminalType())};
}

ScreenSize CursesScreen::size() const { return {::getmaxy(stdscr), ::getmaxx(stdscr)}; }

void CursesScreen::show(const CellGrid& grid) {
  ::werase(stdscr);
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      const Cell& cell = grid.at(row, column);
      if (cell == Cell{}) continue;
      const bool shown = cell.glyph < 0x80 || unicode_;
      const wchar_t glyph[] = {static_cast<wchar_t>(shown ? cell.glyph : U'?'), L'\0'};
      cchar_t c{};
      ::setcchar(&c, glyph, attributesOf(cell.style), colours_ ? pairOf(cell.style) : short{0},
                 nullptr);
      ::mvwadd_wch(stdscr, row, column, &c);
    }
  }
  ::wrefresh(stdscr);
}

CursesScreen::Key CursesScreen::key(int timeout_ms) {
  pollfd items[] = {{STDIN_FILENO, POLLIN, 0}, {signals_.get(), POLLIN, 0}};
  ::poll(items, 2, timeout_ms);  // a signal ends the wait when the terminal's size has changed
  if (items[1].revents != 0) return Key::kQuit;
  const int pressed = ::wgetch(stdscr);
  if (pressed == ERR) return (items[0].revents & (POLLHUP | POLLERR)) ? Key::kQuit : Key::kNone;
  if (pressed == KEY_RESIZE) return Key::kResized;
  return pressed == 'q' || pressed == 'Q' || pressed == 3 ? Key::kQuit : Key::kOther;
}

}  // namespace merlin::cli
