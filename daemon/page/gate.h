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
  kReading,  // free on loopback under a name of this machine, unless a proxy passes it on;
             // elsewhere with the token
  kCommand   // always with the token
};

// Nothing if the request may pass; otherwise the answer that refuses it: 400 (a header that counts
// was sent twice), 401 (no token or a wrong one), 403 (another host or site).
std::optional<Answer> refuse(const Request& request, Needs needs, const GateSettings& settings);

// Whether two texts are equal; takes the same time whichever characters differ.
bool sameSecret(std::string_view given, std::string_view secret) noexcept;

// {"error": TEXT} with this status.
Answer errorAnswer(unsigned status, std::string_view text);

}  // namespace merlin::page
