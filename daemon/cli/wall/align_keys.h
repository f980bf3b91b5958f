// Keys of `merlin wall align`: bytes of a terminal in, keys out. Pure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace merlin::cli {

struct AlignKey {
  enum class What {
    kLeft,
    kRight,
    kUp,
    kDown,
    kCorner,
    kNextCorner,
    kNextOutput,
    kPreviousOutput,
    kFine,
    kUndo,
    kRedo,
    kCard,
    kQuit
  };
  What what = What::kQuit;
  bool far = false;  // whether it is a move by ten steps
  int number = 0;    // for kCorner: number of the corner, 0 to 3

  bool operator==(const AlignKey&) const = default;
};

// Explains the keys to people, in one line per entry.
inline constexpr const char* kAlignKeyHelp[] = {
    "arrows or h j k l   move the corner by a step      Shift or H J K L   by ten steps",
    "Tab, 1 2 3 4        choose the corner              n, p               next, previous output",
    "s                   step of 1 or 0.1 pixels        u, r               undo, redo",
    "t                   test card on, off              q                  quit"};

class AlignKeyReader {
 public:
  // The keys that these bytes complete; bytes that belong to no key are ignored. A sequence that
  // begins with Escape may be in several pieces.
  std::vector<AlignKey> feed(std::string_view bytes);

 private:
  std::string pending_;  // beginning of an incomplete sequence
};

}  // namespace merlin::cli
