#include "render/inventor/surface.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace merlin::render::inventor {
namespace {

// Limit of triangle corners, so that the index list, which has one end mark per triangle, still
// fits into an int.
constexpr int kMostCorners = std::numeric_limits<int>::max() / 4 * 3;

// The fields that belong to the dendrogram, in the form that Dendrogram::Arrays views.
struct Tree {
  std::vector<std::uint32_t> faces, parents, alive;
  std::vector<float> error;
};

// Converts a field to unsigned numbers. Negative numbers become very large ones, which
// Dendrogram::make() rejects.
std::vector<std::uint32_t> unsignedOf(const SoMFInt32& field) {
  const std::int32_t* values = field.getValues(0);
  return {values, values + field.getNum()};
}

std::shared_ptr<const Tree> treeOf(const Surface::Fields& fields) {
  auto tree = std::make_shared<Tree>();
  tree->faces = unsignedOf(fields.faces);
  tree->parents = unsignedOf(fields.parents);
  tree->alive = unsignedOf(fields.aliveCounts);
  // Errors stay 0: drawing does not use them, and Coin rounds numbers in text files, so that they
  // might decrease, which Dendrogram::make() would reject.
  tree->error.resize(tree->alive.size());
  return tree;
}

std::span<const float> numbersOf(const SoMFVec3f& field) {
  const auto count = static_cast<std::size_t>(field.getNum());
  if (count == 0) return {};
  return {field.getValues(0)->getValue(), 3 * count};
}

// Checks that the field has `wanted` values, one for each of `things`, or no values.
Result<Ok> checkCount(const char* name, const SoMField& field, int wanted, const char* things) {
  if (field.getNum() == 0 || field.getNum() == wanted) return Ok{};
  return Error{Errc::kMalformed,
               fmt::format("{}: {} values for {} {}", name, field.getNum(), wanted, things)};
}

Result<Ok> checkCounts(const Surface::Fields& fields) {
  const struct {
    const char* name;
    const SoMField& field;
  } kOfNodes[] = {{"normal", fields.normal},
                  {"diffuseColor", fields.diffuseColor},
                  {"texCoord", fields.texCoord}};
  for (const auto& of : kOfNodes) {
    const auto right = checkCount(of.name, of.field, fields.vertex.getNum(), "nodes (vertex)");
    if (!right) return right.error();
  }
  return checkCount("levelErrors", fields.levelErrors, fields.aliveCounts.getNum(),
                    "levels (aliveCounts)");
}

// Returns a colour component as a byte; 0 for NaN, since casting NaN is undefined.
std::uint32_t byteOf(float part) {
  if (!(part > 0)) return 0;
  return part < 1 ? static_cast<std::uint32_t>(std::lround(part * 255)) : 255;
}

void packColours(const SoMFColor& from, SoMFUInt32& to) {
  to.setNum(from.getNum());
  std::uint32_t* packed = to.startEditing();
  for (int i = 0; i < from.getNum(); ++i) {
    const SbColor& c = from[i];
    packed[i] = byteOf(c[0]) << 24 | byteOf(c[1]) << 16 | byteOf(c[2]) << 8 | 0xFF;
  }
  to.finishEditing();
}

}  // namespace

Surface::Surface(const Fields& fields) : attributes_(new SoVertexProperty) {
  attributes_->ref();
  attributes_->vertex = fields.vertex;
  attributes_->normal = fields.normal;
  attributes_->normalBinding = SoVertexProperty::PER_VERTEX_INDEXED;
  attributes_->texCoord = fields.texCoord;
  packColours(fields.diffuseColor, attributes_->orderedRGBA);
  attributes_->materialBinding = SoVertexProperty::PER_VERTEX_INDEXED;
  for (Cut& copy : copies_) {
    copy.faces = new SoIndexedFaceSet;
    copy.faces->ref();
    copy.faces->vertexProperty = attributes_;
  }
}

Surface::~Surface() {
  for (Cut& copy : copies_) copy.faces->unref();
  attributes_->unref();
}

Result<std::unique_ptr<Surface>> Surface::make(const Fields& fields) {
  std::unique_ptr<Surface> surface(new Surface(fields));
  if (const auto checked = surface->check(fields); !checked) return checked.error();
  return surface;
}

Result<Ok> Surface::check(const Fields& fields) {
  const int nodes = fields.vertex.getNum();
  if (nodes == 0 || fields.faces.getNum() == 0) {
    return Error{Errc::kMalformed, fmt::format("vertex has {} values and faces {}: no triangle",
                                               nodes, fields.faces.getNum())};
  }
  if (fields.faces.getNum() > kMostCorners) {
    return Error{Errc::kMalformed, fmt::format("faces: {} values, more than {}",
                                               fields.faces.getNum(), kMostCorners)};
  }
  if (const auto counts = checkCounts(fields); !counts) return counts.error();
  const auto tree = treeOf(fields);
  lod::Dendrogram::Arrays arrays;
  arrays.positions = numbersOf(attributes_->vertex);
  arrays.triangles = tree->faces;
  arrays.parents = tree->parents;
  arrays.alive = tree->alive;
  arrays.error = tree->error;
  auto made = lod::Dendrogram::make(std::move(arrays), tree);
  if (!made) return made.error();
  dendrogram_ = std::make_unique<const lod::Dendrogram>(*std::move(made));
  for (int i = 0; i < nodes; ++i) box_.extendBy(attributes_->vertex[i]);
  return Ok{};
}

std::size_t Surface::trianglesFor(std::size_t budget) const noexcept {
  return dendrogram_->trianglesAt(dendrogram_->levelFor(budget));
}

SoIndexedFaceSet& Surface::at(Copy copy, std::size_t budget) {
  Cut& wanted = copies_[copy];
  const std::size_t level = dendrogram_->levelFor(budget);
  if (!wanted.made || wanted.level != level) cut(wanted, level);
  return *wanted.faces;
}

void Surface::cut(Cut& copy, std::size_t level) const {
  std::vector<std::uint32_t> corners(3 * dendrogram_->trianglesAt(level));
  dendrogram_->cut(level, corners);
  SoMFInt32& index = copy.faces->coordIndex;
  index.setNum(static_cast<int>(corners.size() / 3 * 4));
  std::int32_t* out = index.startEditing();
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) *out++ = static_cast<std::int32_t>(corners[i + k]);
    *out++ = SO_END_FACE_INDEX;
  }
  index.finishEditing();
  copy.level = level;
  copy.made = true;
}

}  // namespace merlin::render::inventor
