// Converts bytes from a terminal to keys of `merlin wall align`. Pure.
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
  bool far = false;  // for a move: whether it is by ten steps
  int number = 0;    // for kCorner: index of the corner, 0 to 3

  bool operator==(const AlignKey&) const = default;
};

// Explanation of the keys for people, one line per entry.
inline constexpr const char* kAlignKeyHelp[] = {
    "arrows or h j k l   move the corner by a step      Shift or H J K L   by ten steps",
    "Tab, 1 2 3 4        choose the corner              n, p               next, previous output",
    "s                   step of 1 or 0.1 pixels        u, r               undo, redo",
    "t                   test card on, off              q                  quit"};

class AlignKeyReader {
 public:
  // Returns the keys that are complete with these bytes; bytes that belong to no key are ignored.
  // An escape sequence may be split over several calls.
  std::vector<AlignKey> feed(std::string_view bytes);

 private:
  std::string pending_;  // beginning of an incomplete sequence
};

}  // namespace merlin::cli
