// The answer to a reload, as JSON: what it did, or why it did nothing.
#pragma once

#include <string>
#include <vector>

#include "daemon/reload/plan.h"

namespace merlin::reload {

// kInvalid: the file has faults, or a changed number that is out of range. kFailed: the file could
// not be processed for another reason, such as lack of memory. kInvalid and kFailed change nothing.
// kRestarts: a changed setting takes effect only at a start; the process starts again at once, with
// the whole new file.
enum class Outcome { kDone, kInvalid, kRestarts, kFailed };
inline constexpr const char* kOutcomeNames[] = {"done", "invalid", "restarts", "failed"};

// An alignment of the wall (merlin wall align) that does not fit its output any more.
struct AsideAlignment {
  std::string output, why;
};

struct Answer {
  Outcome outcome = Outcome::kDone;
  bool only_checked = false;  // only a check was requested: `plan` has what would be swapped
  std::string file;           // the configuration
  std::vector<std::string> findings;  // a line each, as merlind --check-config prints them
  Plan plan;
  std::string failure;  // for kFailed: the reason
  // The alignments that the new settings set aside, and the names of the outputs whose earlier
  // alignments fit the new settings again.
  std::vector<AsideAlignment> set_aside{};
  std::vector<std::string> brought_back{};
};

// Returns the answer as JSON: {"outcome": "done", "only_checked": false, "file": "merlin.json",
// "findings": [...], "swapped": [{"setting": "/bindings/0/action", "from": "\"grab\"", "to":
// "\"fly\""}], "restart": ["/wall/render/gpu"], "elsewhere": [...], "set_aside": [{"output":
// "left", "why": "it was made for 640 x 480 pixels ..."}], "brought_back": ["left"], "failure":
// ""}. `from` and `to` are values as JSON text; empty: there is no such setting.
std::string answerText(const Answer& answer);

// Returns the first setting that makes a restart necessary, and the number of others:
// "/wall/outputs/0/path (and 2 more)". REQUIRES: plan.restart is not empty.
std::string restartReason(const Plan& plan);

// Returns one sentence, for an event, that says why nothing was changed; empty after kDone and
// kRestarts.
std::string refusal(const Answer& answer);

}  // namespace merlin::reload
