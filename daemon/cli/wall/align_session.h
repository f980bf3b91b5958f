// AlignSession: executes the keys of `merlin wall align`, and composes the lines on the screen.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/cli/wall/align_keys.h"
#include "daemon/cli/wall/aligned_wall.h"

namespace merlin::cli {

// The requests to the wall that a session needs; tests replace them.
struct AlignLink {
  std::function<Result<AlignAnswer>(const state::AlignRequest&)> ask;
  std::function<Result<Ok>(const std::string& card)> show_card;  // name of a test card, or "off"
};

class AlignSession {
 public:
  // `output`: name of the output that is selected first; empty: the first output of the wall.
  AlignSession(AlignLink link, std::string output);
  // Removes a test card that the session has shown.
  ~AlignSession();
  AlignSession(const AlignSession&) = delete;
  AlignSession& operator=(const AlignSession&) = delete;

  // Reads the positions of the corners; to be called before the other functions. Errors: those of
  // the wall; kInvalidArgument (the wall has no output that can be aligned, or none with the given
  // name).
  Result<Ok> begin();

  // Executes a key; returns false if it ends the session. Errors are shown on the screen.
  bool press(const AlignKey& key);

  // Reads the positions of the corners again, because other programs may move them too.
  void refresh();

  // Returns the lines to show on the terminal.
  std::vector<std::string> screen() const;

 private:
  const AlignedPicture& picture() const { return answer_.outputs[output_]; }
  // Returns the corner of the output's signal that appears at the chosen corner on the wall.
  state::Place place() const { return state::cornerAt(picture().axes.cornerOnSignal(corner_)); }
  void ask(const state::AlignRequest& request);
  void choose(std::size_t output, std::size_t corner);
  void move(const AlignKey& key);
  void toggleCard();

  AlignLink link_;
  std::string first_output_, message_;
  AlignAnswer answer_;
  // Index of the selected output, and index of the selected corner as seen on the wall.
  std::size_t output_ = 0, corner_ = 0;
  bool fine_ = false, card_ = false;
};

}  // namespace merlin::cli
