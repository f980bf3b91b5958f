#include "render/import/assimp_values.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include <assimp/scene.h>

#include "daemon/base/printable_text.h"
#include "render/mesh/coincident.h"

namespace merlin::render::import {
namespace {

bool hasTriangles(const aiMesh& mesh) {
  return (mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) != 0;
}

bool sameFeatures(const GltfValues& a, const GltfValues& b) {
  return std::ranges::equal(a.features, b.features, [](const GltfFeature& f, const GltfFeature& g) {
    return f.name == g.name && f.bytes == g.bytes;
  });
}

// Finds the file's values for the vertices of assimp's meshes. Meshes are recognised by the
// positions of their vertices, in the same order, since assimp's meshes need not be in the order of
// the file's primitives.
class ValueFinder {
 public:
  explicit ValueFinder(const std::vector<GltfValues>& own) {
    for (const GltfValues& values : own) {
      // Two entries suffice, the first one and one that differs: a file may have thousands of equal
      // parts.
      auto& there = by_place_[hashOf(floatsOf(values.positions))];
      if (there.empty() || (there.size() == 1 && !sameFeatures(*there[0], values)))
        there.push_back(&values);
    }
  }

  // Returns the values of a mesh; null if the file has none for it, or if primitives at the same
  // positions have different values.
  const GltfValues* find(const aiMesh& mesh) const {
    std::vector<float> places;
    places.reserve(3 * std::size_t{mesh.mNumVertices});
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& at = mesh.mVertices[v];
      places.insert(places.end(), {at.x, at.y, at.z});
    }
    const auto found = by_place_.find(hashOf(places));
    if (found == by_place_.end() || floatsOf(found->second[0]->positions) != places) return nullptr;
    const bool one = std::ranges::all_of(found->second, [&](const GltfValues* other) {
      return sameFeatures(*other, *found->second[0]);
    });
    return one ? found->second[0] : nullptr;
  }

 private:
  static std::uint64_t hashOf(const std::vector<float>& places) {
    std::uint64_t hash = places.size();
    for (std::size_t i = 0; i + 2 < places.size(); i += 3)
      hash = (hash ^ mesh::hashOfPlace(&places[i])) * 0x9E3779B97F4A7C15U;
    return hash;
  }

  std::map<std::uint64_t, std::vector<const GltfValues*>> by_place_;
};

// Removes from `features` those that `others` does not have.
void keepCommon(const std::vector<GltfFeature>& others, std::vector<GltfFeature>& features) {
  std::erase_if(features, [&](const GltfFeature& f) {
    return std::ranges::find(others, f.name, &GltfFeature::name) == others.end();
  });
}

}  // namespace

OwnValues takeOwnValues(GltfPromise& promised, const aiScene& scene) {
  OwnValues all;
  if (promised.own.empty()) return all;
  const ValueFinder finder(promised.own);
  std::vector<const GltfValues*> of_mesh(scene.mNumMeshes);
  std::vector<GltfFeature> common;
  bool first = true;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    all.first_rows.push_back(all.rows);
    if (!hasTriangles(mesh)) continue;
    of_mesh[m] = finder.find(mesh);
    if (!of_mesh[m]) return {};
    all.rows += mesh.mNumVertices;
    if (std::exchange(first, false))
      common = of_mesh[m]->features;
    else
      keepCommon(of_mesh[m]->features, common);
  }
  if (all.rows > std::numeric_limits<std::uint32_t>::max()) return {};  // rows have 32 bits
  for (const GltfFeature& f : common) {
    mesh::Feature& made = all.features.emplace_back(mesh::Feature{f.name, f.dimension, {}});
    made.values.reserve(all.rows * f.dimension);
    for (const GltfValues* values : of_mesh) {
      if (!values) continue;
      const auto part =
          floatsOf(std::ranges::find(values->features, f.name, &GltfFeature::name)->bytes);
      made.values.insert(made.values.end(), part.begin(), part.end());
    }
    promised.own_attributes.erase(oneLine(excerpt("_" + f.name)));
  }
  return all;
}

}  // namespace merlin::render::import
