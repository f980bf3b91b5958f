#include "daemon/page/gate.h"

#include <fmt/format.h>

#include "daemon/base/printable_text.h"
#include "daemon/json/json_tree.h"
#include "daemon/page/host_names.h"

namespace merlin::page {
namespace {

constexpr std::string_view kBearer = "Bearer ";

// Returns the part of an Origin that a Host also has: "127.0.0.1:7480" of "http://127.0.0.1:7480".
std::optional<std::string_view> authorityOf(std::string_view origin) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.starts_with(scheme)) return origin.substr(scheme.size());
  }
  return std::nullopt;
}

std::optional<Answer> refuseHost(const Request& request, const std::optional<std::string>& host,
                                 const GateSettings& settings) {
  if (host && isOwnHost(*host, settings.host_names)) return std::nullopt;
  return errorAnswer(
      403,
      fmt::format("the Host \"{}\" is not a name of this page: use an address or localhost, or add "
                  "the name to /page/host_names",
                  excerpt(request.header("host"))));
}

// Refuses what pages of other sites ask for, reading and commands alike, whatever the browser
// allows.
std::optional<Answer> refuseSite(const Request& request) {
  const std::string& origin = request.header("origin");
  const auto authority = authorityOf(origin);
  if (!origin.empty() && authority != request.header("host"))
    return errorAnswer(403,
                       fmt::format("requests from the site \"{}\" are refused", excerpt(origin)));
  const std::string& site = request.header("sec-fetch-site");
  const bool followed_link = request.header("sec-fetch-mode") == "navigate";
  if (site.empty() || site == "same-origin" || site == "none" || followed_link) return std::nullopt;
  return errorAnswer(403, "requests from other sites are refused");
}

std::optional<Answer> refuseToken(const Request& request, const GateSettings& settings) {
  const std::string_view given = request.header("authorization");
  std::string why = "a token is needed, as the header Authorization: Bearer TOKEN";
  if (given.starts_with(kBearer)) {
    if (sameSecret(given.substr(kBearer.size()), settings.token)) return std::nullopt;
    why = "the token is wrong";
  }
  Answer answer = errorAnswer(401, why);
  answer.headers.emplace_back("WWW-Authenticate", "Bearer");
  return answer;
}

}  // namespace

Answer errorAnswer(unsigned status, std::string_view text) {
  return Answer::text(status, "application/json",
                      fmt::format("{{\"error\":{}}}\n", jsonText(text)));
}

bool sameSecret(std::string_view given, std::string_view secret) noexcept {
  if (secret.empty()) return false;
  // The length may be compared first, because the length of a token is no secret.
  if (given.size() != secret.size()) return false;
  volatile unsigned char difference = 0;
  for (std::size_t i = 0; i < secret.size(); ++i) {
    difference = static_cast<unsigned char>(difference | (static_cast<unsigned char>(given[i]) ^
                                                          static_cast<unsigned char>(secret[i])));
  }
  return difference == 0;
}

std::optional<Answer> refuse(const Request& request, Needs needs, const GateSettings& settings) {
  if (request.repeated) return errorAnswer(400, "a header was sent twice");
  const auto host = hostOf(request.header("host"));
  if (auto refused = refuseHost(request, host, settings)) return refused;
  if (auto refused = refuseSite(request)) return refused;
  // A proxy on this machine has a loopback address and may use a loopback name as Host, so a
  // request that it passes on for another machine needs the token.
  const bool free =
      needs == Needs::kReading && settings.loopback && isLoopbackHost(*host) && !request.passed_on;
  if (needs == Needs::kNothing || free) return std::nullopt;
  return refuseToken(request, settings);
}

}  // namespace merlin::page
