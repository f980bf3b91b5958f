// DrmProperties: the ids of the properties of a card's objects, by name.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <xf86drmMode.h>

namespace merlin::render::out::kms {

// Thread-bound. Looks up properties by name; `type` is the object's DRM_MODE_OBJECT_ constant. The
// kernel never changes a property's id, so the ids of an object are read only once.
class DrmProperties {
 public:
  // idOf() returns 0, and valueOf() nothing, if the object has no property of this name.
  std::uint32_t idOf(int fd, std::uint32_t object, std::uint32_t type, const std::string& name);
  std::optional<std::uint64_t> valueOf(int fd, std::uint32_t object, std::uint32_t type,
                                       const std::string& name);

 private:
  std::map<std::uint32_t, std::map<std::string, std::uint32_t>> ids_;  // by object
};

}  // namespace merlin::render::out::kms
