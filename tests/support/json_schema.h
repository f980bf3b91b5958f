// JsonSchema: checks documents against a JSON schema. It knows the part of the schema language that
// daemon/status/status.schema.json uses: $ref into $defs, type, enum, properties, required,
// additionalProperties, patternProperties, items, minItems, maxItems, anyOf. It is stricter than
// the language: a member that the schema does not describe is a fault.
#pragma once

#include <algorithm>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace merlin::test {

class JsonSchema {
 public:
  using Json = nlohmann::json;

  explicit JsonSchema(Json root) : root_(std::move(root)) {}

  // Returns the faults of the document, one sentence each; empty if the document conforms to the
  // schema's definition /$defs/`definition`.
  std::vector<std::string> faults(const std::string& definition, const Json& document) const {
    std::vector<std::string> found;
    check(root_.at("$defs").at(definition), document, definition, found);
    return found;
  }

  // Returns every member that the schema describes, with its type, in the format of
  // tests/data/status_promises.txt.
  std::vector<std::string> members() const {
    std::vector<std::string> lines;
    for (const auto& [name, schema] : root_.at("$defs").items()) list(name, schema, false, lines);
    return lines;
  }

 private:
  using Faults = std::vector<std::string>;

  static bool isOf(const std::string& type, const Json& value) {
    if (type == "integer") return value.is_number_integer();
    if (type == "number") return value.is_number();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    return type == "null" && value.is_null();
  }

  static std::vector<std::string> typesOf(const Json& schema) {
    if (!schema.contains("type")) return {};
    if (schema["type"].is_string()) return {schema["type"]};
    return schema["type"];
  }

  const Json& resolved(const Json& schema) const {
    if (!schema.contains("$ref")) return schema;
    const std::string name = schema["$ref"].get<std::string>().substr(8);  // after "#/$defs/"
    return root_.at("$defs").at(name);
  }

  void check(const Json& unresolved, const Json& value, const std::string& at,
             Faults& found) const {
    const Json& schema = resolved(unresolved);
    if (schema.contains("anyOf")) return checkAny(schema["anyOf"], value, at, found);
    const auto types = typesOf(schema);
    const auto fits = [&](const std::string& type) { return isOf(type, value); };
    if (!types.empty() && std::none_of(types.begin(), types.end(), fits))
      found.push_back(fmt::format("{}: is {}", at, value.dump()));
    if (schema.contains("enum") && !value.is_null() &&
        std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
      found.push_back(fmt::format("{}: is {}, which is none of its values", at, value.dump()));
    if (value.is_object()) checkMembers(schema, value, at, found);
    if (value.is_array()) checkItems(schema, value, at, found);
  }

  void checkAny(const Json& alternatives, const Json& value, const std::string& at,
                Faults& found) const {
    Faults of_all;
    for (const Json& alternative : alternatives) {
      Faults of_one;
      check(alternative, value, at, of_one);
      if (of_one.empty()) return;
      of_all.insert(of_all.end(), of_one.begin(), of_one.end());
    }
    found.push_back(
        fmt::format("{}: is none of the alternatives: {}", at, fmt::join(of_all, "; ")));
  }

  void checkItems(const Json& schema, const Json& value, const std::string& at,
                  Faults& found) const {
    if (value.size() < schema.value("minItems", std::size_t{0}) ||
        value.size() > schema.value("maxItems", ~std::size_t{0}))
      found.push_back(fmt::format("{}: has {} items", at, value.size()));
    if (!schema.contains("items")) return;  // not a list, which check() has reported
    for (const Json& item : value) check(schema["items"], item, at + "/#", found);
  }

  void checkMembers(const Json& schema, const Json& value, const std::string& at,
                    Faults& found) const {
    for (const Json& name : schema.value("required", Json::array())) {
      if (!value.contains(name.get<std::string>()))
        found.push_back(fmt::format("{}: has no {}", at, name.get<std::string>()));
    }
    for (const auto& [name, member] : value.items()) {
      if (const Json* const described = describedBy(schema, name))
        check(*described, member, at + "/" + name, found);
      else
        found.push_back(fmt::format("{}/{}: is not in the schema", at, name));
    }
  }

  static const Json* describedBy(const Json& schema, const std::string& name) {
    if (schema.contains("properties") && schema["properties"].contains(name))
      return &schema["properties"][name];
    if (schema.contains("patternProperties")) {
      for (const auto& [pattern, described] : schema["patternProperties"].items()) {
        if (std::regex_search(name, std::regex(pattern))) return &described;
      }
    }
    const auto other = schema.find("additionalProperties");
    return other != schema.end() && other->is_object() ? &*other : nullptr;
  }

  static std::string kindOf(const Json& schema) {
    if (schema.contains("anyOf")) {
      std::vector<std::string> names;
      for (const Json& one : schema["anyOf"])
        names.push_back(one["$ref"].get<std::string>().substr(8));
      return fmt::format("any of {}", fmt::join(names, "|"));
    }
    if (schema.contains("$ref")) return "-> " + schema["$ref"].get<std::string>().substr(8);
    return fmt::format("{}", fmt::join(typesOf(schema), "|"));
  }

  void list(const std::string& at, const Json& schema, bool required, Faults& lines) const {
    lines.push_back(fmt::format("{} {}{}", at, kindOf(schema), required ? " required" : ""));
    const auto needed = schema.value("required", std::vector<std::string>());
    const auto each = [&](const char* keyword, const char* before) {
      if (!schema.contains(keyword)) return;
      for (const auto& [name, member] : schema[keyword].items()) {
        const bool always = std::find(needed.begin(), needed.end(), name) != needed.end();
        list(at + before + name, member, always, lines);
      }
    };
    each("properties", "/");
    each("patternProperties", "/~");
    if (schema.contains("additionalProperties"))
      list(at + "/*", schema["additionalProperties"], false, lines);
    if (schema.contains("items")) list(at + "/#", schema["items"], false, lines);
  }

  Json root_;
};

}  // namespace merlin::test
