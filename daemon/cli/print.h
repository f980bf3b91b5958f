// Output of the subcommands, for people and for programs; safe for any bytes that come from files
// and arguments.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/log.h"
#include "daemon/base/printable_text.h"

namespace merlin::cli {

// Prints to stdout like fmt::print(), with control characters escaped (printable()).
template <typename... Args>
void printOut(fmt::format_string<Args...> format, Args&&... args) {
  fmt::print("{}", printable(fmt::format(format, std::forward<Args>(args)...)));
}

// Prints "merlin: note: TEXT" to stderr.
inline void printNote(std::string_view text) { printError("merlin: note: {}\n", printable(text)); }

// Returns the JSON as one line of text; bytes that are not valid UTF-8 are replaced.
template <typename Json>
std::string jsonText(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// Prints the JSON on one line to stdout.
template <typename Json>
void printJsonLine(const Json& json) {
  fmt::print("{}\n", jsonText(json));
}

}  // namespace merlin::cli
