// The JSON documents that the page and other programs read under /api. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/page/exchange.h"
#include "daemon/page/qr_code.h"

namespace merlin::page {

struct RoleState {
  std::string role;
  bool running = false;
  std::string status;  // the role's own document, a JSON object; empty: nothing yet
  Duration age{};      // time since `status` arrived
};

// A content of the configuration, for a person to choose.
struct ContentState {
  std::string name, kind;       // "model", "picture", "panorama", "slides"
  std::uint64_t thumbnail = 0;  // number of its small picture; 0: there is none
  std::string fault;            // why its file cannot be read; empty: nothing is known
};

// A content that is not in the configuration, as the wall showed it.
struct ShownState {
  std::string name;
  std::uint64_t thumbnail = 0;  // number of its small picture
  std::uint64_t place = 0;      // by which its picture is requested: see Thumbnails::jpeg()
};

// The QR code for a phone's camera, and the address that it contains.
struct PhoneState {
  std::string address;  // of the page, without the token; empty: a phone cannot reach it
  std::string why;      // why a phone cannot reach the page
  QrCode code;
};

struct PageState {
  std::string instance, version;
  std::string token_file;  // path of the file with the token
  double picture_hz = 0;   // pictures per second at most
};

// Returns {"page": {...}, "roles": {"wall": {"running", "age_s", "status": {...} or null}, ...}}.
std::string statusDocument(const PageState& page, const std::vector<RoleState>& roles);

// Returns {"contents": [{"name", "kind", "thumbnail": NUMBER or null, "fault"}, ...],
// "shown": [{"name", "thumbnail": NUMBER, "place": NUMBER}, ...]}.
std::string contentsDocument(const std::vector<ContentState>& contents,
                             const std::vector<ShownState>& shown);

// Returns {"address": TEXT or null, "why": TEXT, "rows": ["1101...", ...]}: 1 is dark.
std::string phoneDocument(const PhoneState& phone);

// Returns {"commands": [{"name", "role", "argument", "help", "button", "choices"}]}: the commands
// that the page may send; `button`: whether the command needs no argument; `choices`: the possible
// arguments, if these are known (names of test cards). The list is the same for every daemon of one
// release.
std::string commandList();

// Returns the answer to a command: {"ok": true, "result": ...}, or {"ok": false, "error": ...} with
// a status of 400 (refused), 503 (the role does not run) or 504 (no answer).
Answer commandAnswer(const Result<std::string>& result);

}  // namespace merlin::page
