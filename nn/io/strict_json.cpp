#include "nn/io/strict_json.h"

#include <algorithm>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace merlin::nn {
namespace {

using nlohmann::json;

constexpr std::size_t kMostLevels = 8;
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

std::string quote(const json& value) {
  if (value.is_object()) return fmt::format("an object of {} keys", value.size());
  if (value.is_array()) return fmt::format("an array of {} elements", value.size());
  const std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  return text.size() > kMostQuoted ? text.substr(0, kMostQuoted) + "..." : text;
}

// Walks through a text without building anything. nlohmann itself lets the last of two equal keys
// win, and recurses as deep as the text does when it copies a document.
class Guard : public nlohmann::json_sax<json> {
 public:
  explicit Guard(const std::string& file) : file_(file) {}

  const std::optional<Error>& error() const { return error_; }

  bool null() override { return value(); }
  bool boolean(bool) override { return value(); }
  bool number_integer(number_integer_t) override { return value(); }
  bool number_unsigned(number_unsigned_t) override { return value(); }
  bool number_float(number_float_t, const string_t&) override { return value(); }
  bool string(string_t&) override { return value(); }
  bool binary(binary_t&) override { return value(); }
  bool start_object(std::size_t) override { return open(false); }
  bool start_array(std::size_t) override { return open(true); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    Level& level = levels_.back();
    level.key = name.substr(0, kMostQuoted);
    if (level.keys.insert(name).second) return true;
    return fail("the key twice", "each key once");
  }

  bool parse_error(std::size_t, const std::string&, const json::exception& ex) override {
    std::string_view what = ex.what();  // "[json.exception.NAME.NUMBER] parse error at line ..."
    what.remove_prefix(std::min(what.find(' ') + 1, what.size()));
    return fail(what, "JSON");
  }

 private:
  struct Level {
    bool array;
    std::size_t index = 0;
    std::string key;
    std::set<std::string> keys;
  };

  bool fail(std::string_view found, std::string_view allowed) {
    std::string pointer;
    for (const Level& level : levels_) {
      pointer += level.array ? step(std::to_string(level.index)) : step(level.key);
    }
    error_ = errorAt(Errc::kMalformed, file_, pointer, found, allowed);
    return false;
  }

  bool open(bool array) {
    if (levels_.size() == kMostLevels) {
      return fail("one more level", fmt::format("{} levels", kMostLevels));
    }
    levels_.push_back({array, 0, {}, {}});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return value();
  }

  bool value() {
    if (!levels_.empty()) ++levels_.back().index;
    return true;
  }

  const std::string& file_;
  std::vector<Level> levels_;
  std::optional<Error> error_;
};

}  // namespace

Result<Ok> checkJson(std::string_view text, const std::string& file) {
  Guard guard(file);
  if (json::sax_parse(text, &guard)) return Ok{};
  return guard.error().value_or(Error{Errc::kMalformed, file + ": not JSON"});
}

void JsonView::wrong(std::string_view allowed, std::string_view found, Errc code) {
  if (error_ || !value_) return;
  error_ = errorAt(code, file_, pointer_, found.empty() ? quote(*value_) : found, allowed);
}

void JsonView::allowKeys(std::initializer_list<const char*> keys) {
  if (!value_) return;
  if (!value_->is_object()) return wrong("an object");
  for (const auto& [key, value] : value_->items()) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    std::string list;
    for (const char* k : keys) list += list.empty() ? k : fmt::format(", {}", k);
    return wrong(list, fmt::format("the key {}", quote(key)));
  }
}

std::size_t JsonView::expectArray(std::size_t least, std::size_t most) {
  if (!value_) return 0;
  const std::size_t size = value_->is_array() ? value_->size() : 0;
  if (value_->is_array() && size >= least && size <= most) return size;
  wrong(least == most ? fmt::format("an array of {} elements", least)
                      : fmt::format("an array of {} to {} elements", least, most));
  return 0;
}

JsonView JsonView::at(const char* key) const {
  const json* child = nullptr;
  if (value_ && value_->is_object()) {
    const auto found = value_->find(key);
    if (found != value_->end()) child = &*found;
  }
  JsonView view(child, pointer_ + step(key), file_, error_);
  if (!child && value_ && !error_) {
    error_ =
        errorAt(Errc::kMalformed, file_, view.pointer_, "nothing", "a value: the key is missing");
  }
  return view;
}

JsonView JsonView::at(std::size_t index) const {
  const bool there = value_ && value_->is_array() && index < value_->size();
  return {there ? &(*value_)[index] : nullptr, pointer_ + step(std::to_string(index)), file_,
          error_};
}

double JsonView::number(double low, double high) {
  if (!value_) return 0;
  const double v = value_->is_number() ? value_->get<double>() : 0;
  if (value_->is_number() && v >= low && v <= high) return v;
  wrong(fmt::format("a number from {} to {}", low, high));
  return 0;
}

std::uint64_t JsonView::count(std::uint64_t low, std::uint64_t high) {
  if (!value_) return 0;
  const auto v = value_->is_number_unsigned() ? value_->get<std::uint64_t>() : 0;
  if (value_->is_number_unsigned() && v >= low && v <= high) return v;
  wrong(low == high ? fmt::format("{}", low) : fmt::format("an integer from {} to {}", low, high));
  return 0;
}

bool JsonView::boolean() {
  if (!value_) return false;
  if (value_->is_boolean()) return value_->get<bool>();
  wrong("true or false");
  return false;
}

std::string JsonView::text(std::size_t longest) {
  if (!value_) return {};
  if (value_->is_string() && value_->get_ref<const std::string&>().size() <= longest) {
    return value_->get<std::string>();
  }
  wrong(fmt::format("a string of at most {} characters", longest));
  return {};
}

}  // namespace merlin::nn
