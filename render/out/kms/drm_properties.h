// DrmProperties: the numbers of the properties of a card's objects, by their names.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <xf86drmMode.h>

namespace merlin::render::out::kms {

// Thread-bound. The kernel numbers properties once and for all, so each object is asked once.
class DrmProperties {
 public:
  // 0: the object has no property of this name.
  std::uint32_t idOf(int fd, std::uint32_t object, std::uint32_t type, const std::string& name);
  std::optional<std::uint64_t> valueOf(int fd, std::uint32_t object, std::uint32_t type,
                                       const std::string& name);

 private:
  std::map<std::uint32_t, std::map<std::string, std::uint32_t>> ids_;  // by object
};

}  // namespace merlin::render::out::kms
