#include "render/out/kms/drm_properties.h"

#include <memory>

namespace merlin::render::out::kms {
namespace {

using Properties = std::unique_ptr<drmModeObjectProperties, decltype(&drmModeFreeObjectProperties)>;

Properties propertiesOf(int fd, std::uint32_t object, std::uint32_t type) {
  return {drmModeObjectGetProperties(fd, object, type), drmModeFreeObjectProperties};
}

}  // namespace

std::uint32_t DrmProperties::idOf(int fd, std::uint32_t object, std::uint32_t type,
                                  const std::string& name) {
  auto known = ids_.find(object);
  if (known == ids_.end()) {
    known = ids_.emplace(object, std::map<std::string, std::uint32_t>()).first;
    const Properties all = propertiesOf(fd, object, type);
    for (std::uint32_t i = 0; all && i < all->count_props; ++i) {
      drmModePropertyRes* const property = drmModeGetProperty(fd, all->props[i]);
      if (!property) continue;
      known->second[property->name] = property->prop_id;
      drmModeFreeProperty(property);
    }
  }
  const auto found = known->second.find(name);
  return found == known->second.end() ? 0 : found->second;
}

std::optional<std::uint64_t> DrmProperties::valueOf(int fd, std::uint32_t object,
                                                    std::uint32_t type, const std::string& name) {
  const std::uint32_t id = idOf(fd, object, type, name);
  const Properties all = propertiesOf(fd, object, type);
  for (std::uint32_t i = 0; id != 0 && all && i < all->count_props; ++i) {
    if (all->props[i] == id) return all->prop_values[i];
  }
  return std::nullopt;
}

}  // namespace merlin::render::out::kms
