#include "daemon/json/json_view.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace merlin {
namespace {

constexpr std::size_t kMostQuoted = 40;  // characters of a value in an error

std::string step(std::string_view key) {
  std::string escaped = "/";
  for (const char c : key) escaped += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return escaped;
}

Error errorAt(Errc code, const std::string& file, const std::string& pointer,
              std::string_view found, std::string_view allowed) {
  return {code, fmt::format("{}: {}: found {}; allowed: {}", file,
                            pointer.empty() ? "(root)" : pointer, found, allowed)};
}

std::string quoteText(const std::string& value) {
  std::string text =
      nlohmann::json(value).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  if (text.size() > kMostQuoted) text.replace(kMostQuoted, std::string::npos, "...");
  return text;
}

std::string quote(const JsonNode& value) {
  switch (value.kind) {
    case JsonNode::Kind::kObject: return fmt::format("an object of {} keys", value.members.size());
    case JsonNode::Kind::kArray: return fmt::format("an array of {} elements", value.items.size());
    case JsonNode::Kind::kString: return quoteText(value.text);
    case JsonNode::Kind::kBool: return value.boolean ? "true" : "false";
    case JsonNode::Kind::kNumber: return fmt::format("{}", value.number);
    case JsonNode::Kind::kNull: break;
  }
  return "null";
}

const JsonNode* find(const JsonNode& object, std::string_view key) {
  const auto member = std::ranges::find(object.members, key, &JsonNode::Member::key);
  return member == object.members.end() ? nullptr : &member->value;
}

}  // namespace

void JsonView::addFault(std::string_view allowed, std::string_view found, Errc code) {
  if (error_ || !value_) return;
  error_ = errorAt(code, file_, pointer_, found.empty() ? quote(*value_) : found, allowed);
}

void JsonView::allowKeys(std::initializer_list<const char*> keys) {
  if (!value_) return;
  if (value_->kind != JsonNode::Kind::kObject) return addFault("an object");
  for (const auto& [key, line, value] : value_->members) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    std::string list;
    for (const char* k : keys) list += list.empty() ? k : fmt::format(", {}", k);
    return addFault(list, fmt::format("the key {}", quoteText(key)));
  }
}

std::size_t JsonView::expectArray(std::size_t least, std::size_t most) {
  if (!value_) return 0;
  const bool array = value_->kind == JsonNode::Kind::kArray;
  const std::size_t size = value_->items.size();
  if (array && size >= least && size <= most) return size;
  addFault(least == most ? fmt::format("an array of {} elements", least)
                         : fmt::format("an array of {} to {} elements", least, most));
  return 0;
}

JsonView JsonView::at(const char* key) const {
  const JsonNode* const child = value_ ? find(*value_, key) : nullptr;
  JsonView view(child, pointer_ + step(key), file_, error_);
  if (!child && value_ && !error_) {
    error_ =
        errorAt(Errc::kMalformed, file_, view.pointer_, "nothing", "a value: the key is missing");
  }
  return view;
}

JsonView JsonView::at(std::size_t index) const {
  const bool there = value_ && index < value_->items.size();
  return {there ? &value_->items[index] : nullptr, pointer_ + step(std::to_string(index)), file_,
          error_};
}

bool JsonView::has(const char* key) const { return value_ && find(*value_, key); }

double JsonView::number(double low, double high) {
  if (!value_) return 0;
  const double v = value_->number;
  if (value_->kind == JsonNode::Kind::kNumber && v >= low && v <= high) return v;
  addFault(fmt::format("a number from {} to {}", low, high));
  return 0;
}

std::uint64_t JsonView::count(std::uint64_t low, std::uint64_t high) {
  if (!value_) return 0;
  if (value_->count && *value_->count >= low && *value_->count <= high) return *value_->count;
  addFault(low == high ? fmt::format("{}", low)
                       : fmt::format("an integer from {} to {}", low, high));
  return 0;
}

bool JsonView::boolean() {
  if (!value_) return false;
  if (value_->kind == JsonNode::Kind::kBool) return value_->boolean;
  addFault("true or false");
  return false;
}

std::string JsonView::text(std::size_t longest) {
  if (!value_) return {};
  if (value_->kind == JsonNode::Kind::kString && value_->text.size() <= longest)
    return value_->text;
  addFault(fmt::format("a string of at most {} characters", longest));
  return {};
}

}  // namespace merlin
