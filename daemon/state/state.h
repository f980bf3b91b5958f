// State: what people have changed while the daemon runs, which a restart restores. The
// configuration is not changed; the daemon keeps the state in a file of its own. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/base/result.h"
#include "daemon/state/alignment.h"
#include "daemon/state/set_aside.h"

namespace merlin::state {

// Version of the file's form. A program reads files of its own version and of older ones. Version 2
// added `playlist` and `projectors`, version 3 `set_aside`.
inline constexpr std::uint64_t kStateVersion = 3;

// The last switching of all projectors by a person.
struct ProjectorSwitch {
  bool on = false;
  std::int64_t local_minute = 0;  // when: minutes of the local calendar since 1970-01-01 00:00
};

struct State {
  Alignment alignment;
  std::optional<double> rate_hz;  // set by hand; none: the configured one
  std::string content;            // path of the content that is shown; empty: the first content
  bool playlist_off = false;      // set by `merlin playlist off`, until `on`
  std::optional<ProjectorSwitch> projectors;  // nothing: nobody has switched them
  SetAside set_aside{};
};

// The alignment that an output of the form `now` has at the next start: its own, or one that was
// set aside; null if there is none that fits.
const OutputAlignment* alignmentFor(const State& state, const OutputForm& now);

// The file's text: JSON, the version first.
std::string stateText(const State& state);

// Strict: unknown keys, numbers out of range, and alignment steps of an output that the file does
// not list are errors, since they show that the file was not written completely. `file`: its name,
// for messages. Errors: kUnsupported (a newer version), kMalformed (everything else).
Result<State> parseState(std::string_view text, const std::string& file);

}  // namespace merlin::state
