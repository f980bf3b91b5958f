// JsonView: reads a JSON document whose form is known. The first value that is wrong is an error
// that says where it is: "FILE: POINTER: found X; allowed: Y", with an RFC 6901 pointer.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/base/result.h"
#include "daemon/json/json_tree.h"

namespace merlin {

// One value of a document, and where it is.
//
// The first thing that is wrong is kept in `error`, which all views of a document share; reading
// goes on with zeros and empty views, so that a reader checks the error once, at its end.
class JsonView {
 public:
  // All of these outlive the view. `value`: nullptr for an empty view.
  JsonView(const JsonNode* value, std::string pointer, const std::string& file,
           std::optional<Error>& error)
      : value_(value), pointer_(std::move(pointer)), file_(file), error_(error) {}

  // Wrong unless this is an object without any key but these; at() finds the one that is missing.
  void allowKeys(std::initializer_list<const char*> keys);
  // Wrong unless this is an array with that many elements; returns how many.
  std::size_t expectArray(std::size_t least, std::size_t most);

  // Wrong if there is no such key; an empty view then.
  JsonView at(const char* key) const;
  // Empty if there is no such element: expectArray() has said so.
  JsonView at(std::size_t index) const;
  bool has(const char* key) const;
  bool isText() const noexcept { return value_ && value_->kind == JsonNode::Kind::kString; }

  // The value, if it is of that kind and within these limits; else wrong, and zero.
  double number(double low, double high);
  std::uint64_t count(std::uint64_t low, std::uint64_t high);
  bool boolean();
  std::string text(std::size_t longest);

  // Marks this value as wrong. `found` is this value itself where it is left out.
  void addFault(std::string_view allowed, std::string_view found = {},
                Errc code = Errc::kMalformed);

 private:
  const JsonNode* value_;
  std::string pointer_;
  const std::string& file_;
  std::optional<Error>& error_;
};

}  // namespace merlin
