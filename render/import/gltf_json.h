// Reads members of JSON from outside.
#pragma once

#include <nlohmann/json.hpp>

namespace merlin::render::import {

// The member of that name; null if there is none, or `object` is no object.
inline const nlohmann::json* memberOf(const nlohmann::json& object, const char* name) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  return object.is_object() && found != object.end() ? &*found : nullptr;
}

}  // namespace merlin::render::import
