#include "daemon/json/json_tree.h"

#include <iterator>
#include <string>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace merlin {
namespace {

// Iterator that counts the lines up to the parser's position. The count rises when the first
// character of a line is passed, not at the newline, because the parser reads one character beyond
// a number.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* begin, const char* at, int* line)
      : begin_(begin), at_(at), line_(line) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    if (at_ != begin_ && at_[-1] == '\n') ++*line_;
    ++at_;
    return *this;
  }
  CountingIterator operator++(int) {
    const CountingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* begin_;
  const char* at_;
  int* line_;
};

class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit TreeBuilder(const int* line) : line_(line) {}

  bool null() override { return place(JsonNode::Kind::kNull); }
  bool boolean(bool value) override {
    if (!place(JsonNode::Kind::kBool)) return false;
    last_->boolean = value;
    return true;
  }
  bool number_integer(number_integer_t value) override {
    return number(static_cast<double>(value));
  }
  bool number_unsigned(number_unsigned_t value) override {
    if (!number(static_cast<double>(value))) return false;
    last_->count = value;
    return true;
  }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool string(string_t& value) override {
    if (!place(JsonNode::Kind::kString)) return false;
    last_->text = std::move(value);
    return true;
  }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(JsonNode::Kind::kObject); }
  bool start_array(std::size_t) override { return open(JsonNode::Kind::kArray); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& value) override {
    const auto [before, fresh] = keys_.back().emplace(value, *line_);
    if (!fresh) {
      return fail(fmt::format("duplicate key \"{}\" in one object, first on line {}", value,
                              before->second));
    }
    open_.back()->members.push_back({std::move(value), *line_, {}});
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& e) override {
    // "[json.exception.parse_error.101] parse error at line 3, column 5: ...": keep the part after
    // the position.
    const std::string what = e.what();
    const auto column = what.find("column");
    const auto from = column == std::string::npos ? what.find("] ") : what.find(": ", column);
    return fail(from == std::string::npos ? what : what.substr(from + 2));
  }

  JsonNode root;
  std::string error;

 private:
  bool fail(std::string text) {
    if (error.empty()) error = fmt::format("line {}: {}", *line_, text);
    return false;
  }
  bool number(double value) {
    if (!place(JsonNode::Kind::kNumber)) return false;
    last_->number = value;
    return true;
  }
  bool place(JsonNode::Kind kind) {
    if (open_.empty()) {
      last_ = &root;
    } else if (open_.back()->kind == JsonNode::Kind::kArray) {
      last_ = &open_.back()->items.emplace_back();
    } else {
      last_ = &open_.back()->members.back().value;
    }
    last_->kind = kind;
    last_->line = *line_;
    return true;
  }
  bool open(JsonNode::Kind kind) {
    if (open_.size() == kMostJsonLevels)
      return fail(fmt::format("more than {} levels deep", kMostJsonLevels));
    if (!place(kind)) return false;
    open_.push_back(last_);
    keys_.emplace_back();
    return true;
  }
  bool close() {
    open_.pop_back();
    keys_.pop_back();
    return true;
  }

  const int* line_;
  // These pointers stay valid: only the innermost open array or object grows.
  std::vector<JsonNode*> open_;
  // Keys of each open object and their lines; searching the members instead would be quadratic.
  std::vector<std::unordered_map<std::string, int>> keys_;
  JsonNode* last_ = nullptr;
};

}  // namespace

std::string describe(const JsonNode& node) {
  switch (node.kind) {
    case JsonNode::Kind::kNull: return "null";
    case JsonNode::Kind::kBool: return node.boolean ? "true" : "false";
    case JsonNode::Kind::kNumber: return fmt::format("the number {}", node.number);
    case JsonNode::Kind::kString:
      return fmt::format("the string \"{}{}\"", node.text.substr(0, 40),
                         node.text.size() > 40 ? "..." : "");
    case JsonNode::Kind::kArray: return fmt::format("a list of {}", node.items.size());
    case JsonNode::Kind::kObject: return "an object";
  }
  return "nothing";
}

Result<JsonNode> parseJson(std::string_view text) {
  if (text.size() > kMostJsonBytes) {
    return Error{Errc::kMalformed, fmt::format("line 1: {} bytes; at most {} are allowed",
                                               text.size(), kMostJsonBytes)};
  }
  int line = 1;
  TreeBuilder builder(&line);
  const char* const first = text.data();
  const CountingIterator begin(first, first, &line), end(first, first + text.size(), &line);
  try {
    if (nlohmann::json::sax_parse(begin, end, &builder) && builder.error.empty())
      return std::move(builder.root);
  } catch (const std::exception& e) {
    return Error{Errc::kMalformed, fmt::format("line {}: {}", line, e.what())};
  }
  return Error{Errc::kMalformed, builder.error.empty()
                                     ? fmt::format("line {}: not valid JSON", line)
                                     : builder.error};
}

std::string jsonText(std::string_view text) {
  return nlohmann::json(std::string(text))
      .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace merlin
