// What commands print for people and for programs, whatever bytes a file or an argument has in it.
#pragma once

#include <cstdio>
#include <string_view>

#include <fmt/format.h>

#include "daemon/base/text.h"

namespace merlin::cli {

// "merlin: note: TEXT" to stderr.
inline void printNote(std::string_view text) {
  fmt::print(stderr, "merlin: note: {}\n", printable(text));
}

// One line of JSON to stdout; what is no UTF-8 in it is replaced.
template <typename Json>
void printJsonLine(const Json& json) {
  fmt::print("{}\n", json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace merlin::cli
