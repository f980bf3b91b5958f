// What commands print for people and for programs, whatever bytes a file or an argument has in it.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/log.h"
#include "daemon/base/text.h"

namespace merlin::cli {

// To stdout as fmt::print() does, but nothing that a terminal would follow.
template <typename... Args>
void say(fmt::format_string<Args...> format, Args&&... args) {
  fmt::print("{}", printable(fmt::format(format, std::forward<Args>(args)...)));
}

// "merlin: note: TEXT" to stderr.
inline void printNote(std::string_view text) { printError("merlin: note: {}\n", printable(text)); }

// On one line; what is no UTF-8 in it is replaced.
template <typename Json>
std::string jsonText(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// The same to stdout.
template <typename Json>
void printJsonLine(const Json& json) {
  fmt::print("{}\n", jsonText(json));
}

}  // namespace merlin::cli
