// A JSON text as a tree that holds the line of each value. nlohmann-json parses the text; its own
// tree has no positions, accepts duplicate keys silently and is recursive without a limit, so the
// tree is built here from its SAX events.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"

namespace merlin {

// What a text may have. A configuration, and every other file that is read this way, stays below.
inline constexpr std::size_t kMostJsonBytes = 1 << 20;
inline constexpr std::size_t kMostJsonLevels = 32;

struct JsonNode {
  enum class Kind { kNull, kBool, kNumber, kString, kArray, kObject };

  struct Member;

  Kind kind = Kind::kNull;
  int line = 0;
  bool boolean = false;
  double number = 0;
  std::optional<std::uint64_t> count{};  // a number that is an integer from 0 on, exactly
  std::string text;                      // value of a string
  std::vector<JsonNode> items;           // elements of an array
  std::vector<Member> members;           // members of an object, in the file's order
};

struct JsonNode::Member {
  std::string key;
  int line = 0;
  JsonNode value;
};

// Describes the value for a message: `the string "abc"`, `the number 3`, `an object`.
std::string describe(const JsonNode& node);

// Errors: kMalformed, with a text that starts with the line ("line 12: ..."): syntax errors found
// by nlohmann-json, a duplicate key in an object, more than 32 levels, more than 1 MiB.
Result<JsonNode> parseJson(std::string_view text);

// The text as JSON, with its quotes; bytes that are not valid UTF-8 are replaced.
std::string jsonText(std::string_view text);

}  // namespace merlin
