// State: the changes that people make while the daemon runs, and that a restart restores. They do
// not change the configuration; the daemon stores them in a file of its own. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "daemon/state/alignment.h"
#include "daemon/state/set_aside.h"

namespace merlin::state {

// Version of the format of the state file. A program reads files of its own version and of older
// ones. Version 2 added `playlist` and `projectors`, version 3 `set_aside`.
inline constexpr std::uint64_t kStateVersion = 3;

// The last time that a person switched all projectors.
struct ProjectorSwitch {
  bool on = false;
  std::int64_t local_minute = 0;  // time in minutes since 1970-01-01 00:00, by the local calendar
};

struct State {
  Alignment alignment;
  std::optional<double> rate_hz;  // frame rate set by command; nothing: the configured one
  std::string content;            // path of the content shown; empty: the first content
  bool playlist_off = false;      // true from `merlin playlist off` until `on`
  std::optional<ProjectorSwitch> projectors;  // nothing: nobody has switched them
  SetAside set_aside{};
};

// Returns the alignment that an output of the form `now` would have after a start: the current one
// of this output, otherwise the newest one that was set aside; null if none fits.
const OutputAlignment* alignmentFor(const State& state, const OutputForm& now);

// Returns the text of the state file: JSON, with the version first.
std::string stateText(const State& state);

// Parses the text of a state file. Unknown keys, numbers out of range, and alignment steps of an
// output that the file does not list are errors, since such a file was not written by merlind or is
// damaged. `file`: the name of the file, for messages. Errors: kUnsupported (a newer version),
// kMalformed (everything else).
Result<State> parseState(std::string_view text, const std::string& file);

}  // namespace merlin::state
