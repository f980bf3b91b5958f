#include "render/import/model_builder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace merlin::render::import {
namespace {

constexpr float kFarthest = 1e18F;  // the limit of validate()

bool isUsable(const Corner& corner) {
  return std::ranges::all_of(corner.position,
                             [](float x) { return std::isfinite(x) && std::abs(x) <= kFarthest; });
}

// Replaces texture coordinates and colours that are not finite by 0, and clamps colours to 0..1.
void clean(Corner& corner) {
  for (float& x : corner.texcoord) x = std::isfinite(x) ? x : 0;
  for (float& x : corner.colour) x = std::isfinite(x) ? std::clamp(x, 0.0F, 1.0F) : 0;
}

}  // namespace

std::size_t ModelBuilder::Hash::operator()(const Key& key) const noexcept {
  std::uint64_t h = 0x9E3779B97F4A7C15U;
  for (const std::uint32_t word : key) {
    h = (h ^ word) * 0xFF51AFD7ED558CCDU;
    h ^= h >> 32;
  }
  return h;
}

void ModelBuilder::beginPart(const mesh::SurfaceTexture& texture) {
  vertices_.clear();
  texture_ = texture;
  part_has_triangles_ = false;
}

void ModelBuilder::dress(Corner& corner) const {
  clean(corner);
  if (!texture_.picture) {
    corner.texcoord = {};
    return;
  }
  const auto [u, v] = corner.texcoord;
  corner.colour = texture_.picture->at(u, v, texture_.wrap_u, texture_.wrap_v);
}

std::uint32_t ModelBuilder::vertexOf(const Corner& corner) {
  const auto& [p, c, t, row] = corner;
  Key key{};
  const float numbers[] = {p[0], p[1], p[2], c[0], c[1], c[2], t[0], t[1]};
  for (std::size_t i = 0; i < std::size(numbers); ++i)
    key[i] = std::bit_cast<std::uint32_t>(numbers[i] + 0.0F);  // turns -0 into 0
  key.back() = row;
  const auto next = static_cast<std::uint32_t>(model_.mesh.vertexCount());
  const auto [found, fresh] = vertices_.try_emplace(key, next);
  if (!fresh) return found->second;
  model_.mesh.positions.insert(model_.mesh.positions.end(), p.begin(), p.end());
  colours_.insert(colours_.end(), c.begin(), c.end());
  texcoords_.insert(texcoords_.end(), t.begin(), t.end());
  labels_.push_back(static_cast<float>(model_.parts - 1));
  if (!values_.empty()) rows_.push_back(row);
  return next;
}

void ModelBuilder::add(std::array<Corner, 3> corners) {
  if (!std::ranges::all_of(corners, isUsable)) {
    ++model_.not_finite;
    return;
  }
  if (!std::exchange(part_has_triangles_, true)) {
    ++model_.parts;
    number_ = textureNumber();
  }
  std::array<std::uint32_t, 3> t{};
  for (std::size_t k = 0; k < 3; ++k) {
    dress(corners[k]);
    coloured_ = coloured_ || corners[k].colour != kPlain;
    t[k] = vertexOf(corners[k]);
  }
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
    ++model_.degenerate;
  } else {
    model_.mesh.triangles.insert(model_.mesh.triangles.end(), t.begin(), t.end());
    textures_.of_triangle.push_back(number_);
  }
}

std::uint32_t ModelBuilder::textureNumber() {
  if (!texture_.picture) return mesh::kNoTexture;
  auto& all = textures_.textures;
  const auto found = std::ranges::find(all, texture_);
  const auto number = static_cast<std::uint32_t>(found - all.begin());
  if (found == all.end()) all.push_back(texture_);
  return number;
}

void ModelBuilder::addValues() {
  for (const mesh::Feature& from : values_) {
    mesh::Feature to{from.name, from.dimension, {}};
    to.values.reserve(rows_.size() * from.dimension);
    for (const std::size_t row : rows_) {
      for (std::size_t k = 0; k < from.dimension; ++k)
        to.values.push_back(from.values[row * from.dimension + k]);
    }
    if (mesh::Feature* const same = model_.mesh.find(to.name))
      *same = std::move(to);
    else
      model_.mesh.features.push_back(std::move(to));
  }
}

BuiltModel ModelBuilder::finish() && {
  mesh::Mesh& mesh = model_.mesh;
  const bool textured = !textures_.textures.empty();
  if (coloured_ || textured) mesh.features.push_back({"colour", 3, std::move(colours_)});
  if (textured) mesh.features.push_back({"texcoord", 2, std::move(texcoords_)});
  if (model_.parts > 1) mesh.features.push_back({"label", 1, std::move(labels_)});
  addValues();
  model_.notes = mesh::joinTextures(mesh, textures_).notes();
  model_.welded = mesh::weldParts(mesh);
  if (model_.not_finite > 0)
    model_.notes.push_back(
        fmt::format("left out: {} triangles with coordinates that are not numbers, or beyond 1e18",
                    model_.not_finite));
  return std::move(model_);
}

}  // namespace merlin::render::import
