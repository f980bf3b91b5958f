// Reads members of JSON from untrusted files, which may have any form.
#pragma once

#include <nlohmann/json.hpp>

namespace merlin::render::import {

// Returns the member called `name`; null if there is none, or if `object` is not a JSON object.
inline const nlohmann::json* memberOf(const nlohmann::json& object, const char* name) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  return object.is_object() && found != object.end() ? &*found : nullptr;
}

}  // namespace merlin::render::import
