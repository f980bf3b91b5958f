// A JSON text as a tree that knows where each value stands. nlohmann-json parses; it gives
// positions for syntax errors only, lets later keys win over earlier ones without a word, and
// recurses without bound, so the tree is built here from its SAX events.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"

namespace merlin {

// Of a configuration.
inline constexpr std::size_t kMostJsonBytes = 1 << 20;

struct JsonNode {
  enum class Kind { kNull, kBool, kNumber, kString, kArray, kObject };

  struct Member;

  Kind kind = Kind::kNull;
  int line = 0;
  bool boolean = false;
  double number = 0;
  std::string text;             // of a string
  std::vector<JsonNode> items;  // of an array
  std::vector<Member> members;  // of an object, in the file's order
};

struct JsonNode::Member {
  std::string key;
  int line = 0;
  JsonNode value;
};

// As a person would say what was found: `a string "abc"`, `the number 3`, `an object`.
std::string describe(const JsonNode& node);

// Errors: kMalformed, starting with the line ("line 12: ..."): what nlohmann finds, a key that
// stands twice in one object, more than 32 levels, more than 1 MiB.
Result<JsonNode> parseJson(std::string_view text);

}  // namespace merlin
