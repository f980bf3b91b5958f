#include "render/mesh/io/obj/obj_parts.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace merlin::render::mesh {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

using Labels = std::vector<std::uint32_t>;
// Key: vertex and part. Value: the part's own copy of the vertex; kNone until it is made.
using Twins = std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>;

Labels lowestParts(const std::vector<std::uint32_t>& part_of, const Mesh& mesh) {
  Labels labels(mesh.vertexCount(), kNone);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::uint32_t& label = labels[mesh.triangles[i]];
    label = std::min(label, part_of[i / 3]);
  }
  return labels;
}

// Returns the keys of the copies that are needed: for each triangle that has no corner with its
// part's label, its first corner.
Twins needed(const std::vector<std::uint32_t>& part_of, const Mesh& mesh, const Labels& labels) {
  Twins twins;
  for (std::size_t t = 0; t < part_of.size(); ++t) {
    const std::uint32_t* corners = &mesh.triangles[3 * t];
    const bool own =
        std::any_of(corners, corners + 3, [&](std::uint32_t v) { return labels[v] == part_of[t]; });
    if (!own) twins.emplace(std::pair(corners[0], part_of[t]), kNone);
  }
  return twins;
}

}  // namespace

void labelParts(const std::vector<std::uint32_t>& part_of, Mesh& mesh) {
  Labels labels = lowestParts(part_of, mesh);
  Twins twins = needed(part_of, mesh, labels);
  for (std::size_t i = 0; i < mesh.triangles.size() && !twins.empty(); ++i) {
    const auto found = twins.find({mesh.triangles[i], part_of[i / 3]});
    if (found == twins.end()) continue;
    if (found->second == kNone) {
      found->second = addCopy(mesh.triangles[i], mesh);
      labels.push_back(part_of[i / 3]);
    }
    mesh.triangles[i] = found->second;
  }
  Feature label{"label", 1, {}};
  label.values.reserve(labels.size());
  for (const std::uint32_t part : labels)
    label.values.push_back(part == kNone ? 0.0F : static_cast<float>(part));
  mesh.features.push_back(std::move(label));
}

}  // namespace merlin::render::mesh
