// AlignSession: what the keys of `merlin wall align` do, and what its screen shows.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/cli/wall/align_keys.h"
#include "daemon/cli/wall/aligned_wall.h"

namespace merlin::cli {

// The wall as a session needs it: a fake in tests.
struct AlignLink {
  std::function<Result<AlignAnswer>(const state::AlignRequest&)> ask;
  std::function<Result<Ok>(const std::string& card)> show_card;  // or "off"
};

class AlignSession {
 public:
  // `output`: the first one that is chosen; empty: the first of all.
  AlignSession(AlignLink link, std::string output);
  // Takes off a test card that the session has put on.
  ~AlignSession();
  AlignSession(const AlignSession&) = delete;
  AlignSession& operator=(const AlignSession&) = delete;

  // Reads where the corners are. Errors: the wall's; kInvalidArgument: it has no output that can
  // be aligned, or none of that name.
  Result<Ok> begin();

  // Does what a key says; false for the one that ends the session. What goes wrong is shown.
  bool press(const AlignKey& key);

  // Asks again where the corners are: others move them too.
  void refresh();

  // Lines for a terminal.
  std::vector<std::string> screen() const;

 private:
  const AlignedPicture& picture() const { return answer_.outputs[output_]; }
  // The signal's corner that is seen in the chosen corner of the wall.
  state::Place place() const { return state::cornerAt(picture().axes.cornerOnSignal(corner_)); }
  void ask(const state::AlignRequest& request);
  void choose(std::size_t output, std::size_t corner);
  void move(const AlignKey& key);
  void toggleCard();

  AlignLink link_;
  std::string first_output_, message_;
  AlignAnswer answer_;
  std::size_t output_ = 0, corner_ = 0;  // the corner as it is seen on the wall
  bool fine_ = false, card_ = false;
};

}  // namespace merlin::cli
