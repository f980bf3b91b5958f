// Gate: decides whether a request may pass, by its Host, its Origin and its token. Pure.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/page/exchange.h"

namespace merlin::page {

struct GateSettings {
  std::string token;  // required for commands, and for reading where that is not free
  std::vector<std::string> host_names;  // names accepted besides addresses and localhost
  bool loopback = true;                 // the server listens at a loopback address
};

// What a request needs.
enum class Needs {
  kNothing,  // the page's own files, which hold nothing of the wall
  kReading,  // without the token if the server listens at a loopback address, the Host is a
             // loopback name, and no proxy passes the request on; otherwise with the token
  kCommand   // always with the token
};

// Returns nothing if the request may pass; otherwise the answer that refuses it: 400 (one of
// kKeptHeaders was sent twice), 401 (no token or a wrong one), 403 (another host or site).
std::optional<Answer> refuse(const Request& request, Needs needs, const GateSettings& settings);

// Whether two texts are equal; false if `secret` is empty. For texts of the same length it takes
// the same time, whichever characters differ.
bool sameSecret(std::string_view given, std::string_view secret) noexcept;

// Returns an answer with this status and the content {"error": TEXT}.
Answer errorAnswer(unsigned status, std::string_view text);

}  // namespace merlin::page
