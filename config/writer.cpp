#include "config/writer.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "config/visitor.h"
#include "daemon/base/absolute_path.h"

namespace merlin {
namespace {

using Json = nlohmann::ordered_json;  // keeps the order of describe()

// Converts a number to JSON. A value that was stored in a float becomes the shortest number that
// gives the same float: 0.1, not 0.10000000149. Other values keep all their digits.
Json plain(double value) {
  if (value == std::floor(value) && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
  const auto narrow = static_cast<float>(value);
  if (static_cast<double>(narrow) != value) return value;
  return std::stod(fmt::format("{}", narrow));
}

class TextWriter final : public SettingsVisitor {
 public:
  explicit TextWriter(Secrets secrets) : secrets_(secrets) {}

  void number(const char* key, double& value, Range, const char*) override {
    (*at_)[key] = plain(value);
  }
  void integer(const char* key, int& value, Range, const char*) override { (*at_)[key] = value; }
  void flag(const char* key, bool& value, const char*) override { (*at_)[key] = value; }
  void text(const char* key, std::string& value, const char*) override { (*at_)[key] = value; }
  void texts(const char* key, std::vector<std::string>& values, const char*) override {
    (*at_)[key] = values;
  }
  void path(const char* key, std::string& value, const char*) override {
    (*at_)[key] = absolutePath(value);
  }
  void secretFile(const char* key, std::string& value, const char*) override {
    (*at_)[key] =
        secrets_ == Secrets::kWritten || value.empty() ? absolutePath(value) : kSecretLeftOut;
  }
  void choice(const char* key, int& value, std::span<const char* const> names,
              const char*) override {
    (*at_)[key] = value < 0 ? "" : names[static_cast<std::size_t>(value)];
  }
  void numbers(const char* key, std::span<double> values, Range, const char*) override {
    Json list = Json::array();
    for (const double v : values) list.push_back(plain(v));
    (*at_)[key] = std::move(list);
  }
  void group(const char* key, const char*, const std::function<void()>& members) override {
    within((*at_)[key] = Json::object(), members);
  }
  void list(const char* key, std::size_t count, const char*,
            const std::function<void(std::size_t)>&,
            const std::function<void(std::size_t)>& member) override {
    Json& list = (*at_)[key] = Json::array();
    for (std::size_t i = 0; i < count; ++i) {
      list.push_back(Json::object());
      within(list.back(), [&] { member(i); });
    }
  }

  void excluded(const char*, const char*) override {}

  Json root = Json::object();

 private:
  void within(Json& object, const std::function<void()>& members) {
    Json* const outer = at_;
    at_ = &object;
    members();
    at_ = outer;
  }
  Secrets secrets_;
  Json* at_ = &root;
};

class SchemaWriter final : public SettingsVisitor {
 public:
  void number(const char* key, double& value, Range range, const char* help) override {
    put(key, {{"type", "number"},
              {"minimum", plain(range.low)},
              {"maximum", plain(range.high)},
              {"default", plain(value)},
              {"description", help}});
  }
  void integer(const char* key, int& value, Range range, const char* help) override {
    put(key, {{"type", "integer"},
              {"minimum", plain(range.low)},
              {"maximum", plain(range.high)},
              {"default", value},
              {"description", help}});
  }
  void flag(const char* key, bool& value, const char* help) override {
    put(key, {{"type", "boolean"}, {"default", value}, {"description", help}});
  }
  void text(const char* key, std::string& value, const char* help) override {
    put(key, {{"type", "string"}, {"default", value}, {"description", help}});
  }
  void texts(const char* key, std::vector<std::string>& values, const char* help) override {
    put(key, {{"type", "array"},
              {"items", {{"type", "string"}}},
              {"default", values},
              {"description", help}});
  }
  void path(const char* key, std::string& value, const char* help) override {
    text(key, value, help);
  }
  void choice(const char* key, int& value, std::span<const char* const> names,
              const char* help) override {
    Json schema = {{"enum", Json(std::vector<std::string>(names.begin(), names.end()))}};
    if (value >= 0) schema["default"] = names[static_cast<std::size_t>(value)];
    schema["description"] = help;
    put(key, std::move(schema));
  }
  void numbers(const char* key, std::span<double> values, Range range, const char* help) override {
    Json defaults = Json::array();
    for (const double v : values) defaults.push_back(plain(v));
    put(key, {{"type", "array"},
              {"items",
               {{"type", "number"}, {"minimum", plain(range.low)}, {"maximum", plain(range.high)}}},
              {"minItems", values.size()},
              {"maxItems", values.size()},
              {"default", defaults},
              {"description", help}});
  }
  void group(const char* key, const char* help, const std::function<void()>& members) override {
    Json object = object_(help);
    within(object, members);
    put(key, std::move(object));
  }
  void groupIf(bool, const char* key, const char* help, const std::function<void()>& members,
               const char*) override {
    group(key, help, members);
  }
  // Describes one entry with the default values of its type, not the default of the list itself.
  // For this, the list has one entry for a moment; its length is then restored, because later
  // settings may depend on whether it is empty.
  void list(const char* key, std::size_t count, const char* help,
            const std::function<void(std::size_t)>& resize,
            const std::function<void(std::size_t)>& member) override {
    Json item = object_("");
    item.erase("description");
    resize(1);
    within(item, [&] { member(0); });
    resize(count);
    put(key, {{"type", "array"}, {"items", std::move(item)}, {"description", help}});
  }

  void excluded(const char*, const char*) override {}

  static Json object_(const char* help) {
    return {{"type", "object"},
            {"additionalProperties", false},
            {"description", help},
            {"properties", Json::object()}};
  }
  void put(const char* key, Json schema) { (*at_)["properties"][key] = std::move(schema); }
  void within(Json& object, const std::function<void()>& members) {
    Json* const outer = at_;
    at_ = &object;
    members();
    at_ = outer;
  }

  Json root = object_("A configuration of merlind. Every setting may be left out.");

 private:
  Json* at_ = &root;
};

}  // namespace

std::string settingsSchema() {
  Settings settings;
  SchemaWriter writer;
  describe(settings, writer);
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "MERLIN"}};
  schema.update(writer.root);
  schema["properties"]["$schema"] = {{"type", "string"}};
  return schema.dump(2) + "\n";
}

std::string settingsText(const Settings& settings, Secrets secrets) {
  Settings copy = settings;  // describe() needs settings that a visitor may change
  TextWriter writer(secrets);
  describe(copy, writer);
  return writer.root.dump(2) + "\n";
}

}  // namespace merlin
