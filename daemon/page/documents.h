// The JSON documents that the page and other programs read under /api. Pure.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/page/exchange.h"

namespace merlin::page {

struct RoleState {
  std::string role;
  bool running = false;
  std::string status;  // the role's own document, a JSON object; empty: nothing yet
  Duration age{};      // since it arrived
};

struct PageState {
  std::string instance, version;
  std::string token_file;  // where the token is, for people
  double picture_hz = 0;   // pictures per second at most
};

// {"page": {...}, "roles": {"wall": {"running", "age_s", "status": {...} or null}, ...}}.
std::string statusDocument(const PageState& page, const std::vector<RoleState>& roles);

// {"commands": [{"name", "role", "argument", "help", "button", "choices"}]}: those that the page
// may send; `button`: whether it needs no argument; `choices`: arguments that it may have, if these
// are known (names of test cards). The same for every daemon of one release.
std::string commandList();

// The answer to a command: {"ok": true, "result": ...}, or {"ok": false, "error": ...} with a
// status of 400 (refused), 503 (the role does not run) or 504 (no answer).
Answer commandAnswer(const Result<std::string>& result);

}  // namespace merlin::page
