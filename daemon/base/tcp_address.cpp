#include "daemon/base/tcp_address.h"

#include <charconv>

namespace merlin {
namespace {

bool isNumber(std::string_view text, int low, int high) {
  int number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end && number >= low && number <= high;
}

bool isHost(std::string_view host) {
  if (host.empty() || host.find_first_of("/ \t\n") != std::string_view::npos) return false;
  if (host.find_first_not_of("0123456789.") != std::string_view::npos) return true;
  int parts = 1;
  for (std::size_t dot = 0; (dot = host.find('.')) != std::string_view::npos; ++parts) {
    if (!isNumber(host.substr(0, dot), 0, 255)) return false;
    host.remove_prefix(dot + 1);
  }
  return parts == 4 && isNumber(host, 0, 255);
}

}  // namespace

std::optional<TcpAddress> parseTcpAddress(std::string_view text) {
  constexpr std::string_view kScheme = "tcp://";
  if (!text.starts_with(kScheme)) return std::nullopt;
  text.remove_prefix(kScheme.size());
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  std::string_view host = text.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  const std::string_view port = text.substr(colon + 1);
  if (!isHost(host) || !isNumber(port, 1, 65535)) return std::nullopt;
  return TcpAddress{std::string(host), std::string(port)};
}

}  // namespace merlin
