#include "daemon/page/host_names.h"

#include <algorithm>
#include <cctype>

#include <arpa/inet.h>
#include <netinet/in.h>

#include "daemon/base/words.h"

namespace merlin::page {
namespace {

constexpr std::size_t kLongest = 253;

bool isPort(std::string_view text) {
  return !text.empty() && text.size() <= 5 &&
         std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool isAddress(const std::string& host, int family) {
  in6_addr parsed{};  // large enough for both
  return ::inet_pton(family, host.c_str(), &parsed) == 1;
}

}  // namespace

bool isHostName(std::string_view name) {
  return !name.empty() && name.size() <= kLongest && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '.';
  });
}

std::vector<std::string> wordsOf(std::string_view text) {
  std::vector<std::string> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    if (end > 0) words.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

std::optional<std::string> hostOf(std::string_view authority) {
  if (authority.starts_with('[')) {
    const std::size_t end = authority.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view rest = authority.substr(end + 1);
    std::string host(authority.substr(1, end - 1));
    const bool good = rest.empty() || (rest[0] == ':' && isPort(rest.substr(1)));
    if (!good || !isAddress(host, AF_INET6)) return std::nullopt;
    return lowerCase(host);
  }
  const std::size_t colon = authority.find(':');
  if (colon != std::string_view::npos && !isPort(authority.substr(colon + 1))) return std::nullopt;
  const std::string_view host = authority.substr(0, colon);
  if (!isHostName(host)) return std::nullopt;
  return lowerCase(host);
}

bool isLoopbackHost(std::string_view host) {
  const std::string text(host);
  return host == "localhost" || host == "::1" ||
         (host.starts_with("127.") && isAddress(text, AF_INET));
}

bool isOwnHost(std::string_view host, std::span<const std::string> names) {
  const std::string text(host);
  if (host == "localhost" || isAddress(text, AF_INET) || isAddress(text, AF_INET6)) return true;
  return std::ranges::any_of(names, [&](const std::string& n) { return lowerCase(n) == host; });
}

}  // namespace merlin::page
