#include "render/import/coin_indices.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <Inventor/VRMLnodes/SoVRMLElevationGrid.h>
#include <Inventor/VRMLnodes/SoVRMLIndexedFaceSet.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/elements/SoLazyElement.h>
#include <Inventor/fields/SoMFInt32.h>
#include <Inventor/fields/SoSFBool.h>
#include <Inventor/fields/SoSFInt32.h>
#include <Inventor/fields/SoSFNode.h>
#include <Inventor/nodes/SoIndexedFaceSet.h>
#include <Inventor/nodes/SoIndexedTriangleStripSet.h>
#include <Inventor/nodes/SoMaterialBinding.h>
#include <Inventor/nodes/SoQuadMesh.h>
#include <Inventor/nodes/SoShape.h>
#include <Inventor/nodes/SoVertexProperty.h>
#include <fmt/format.h>

namespace merlin::render::import {
namespace {

using Indices = std::span<const std::int32_t>;

Error malformed(const std::string& what) { return {Errc::kMalformed, what}; }

// Returns the node's field with this name and type; null if there is none.
template <typename Field>
const Field* fieldOf(const SoNode* node, const char* name) {
  const SoField* const field = node ? node->getField(name) : nullptr;
  return field && field->isOfType(Field::getClassTypeId()) ? static_cast<const Field*>(field)
                                                           : nullptr;
}

// Returns the indices in a field; an empty span if the first one is negative, because in Inventor a
// single -1 means that there are no indices.
Indices indicesOf(const SoShape& shape, const char* name) {
  const auto* const field = fieldOf<SoMFInt32>(&shape, name);
  if (!field || field->getNum() == 0) return {};
  const Indices all(field->getValues(0), static_cast<std::size_t>(field->getNum()));
  return all[0] < 0 ? Indices() : all;
}

// Returns the number of values in the field `values` of the node to which the shape's field `field`
// refers; nothing if it refers to no node.
std::optional<std::int64_t> numberIn(const SoShape& shape, const char* field, const char* values) {
  const auto* const named = fieldOf<SoSFNode>(&shape, field);
  const auto* const all = fieldOf<SoMField>(named ? named->getValue() : nullptr, values);
  return all ? std::optional<std::int64_t>(all->getNum()) : std::nullopt;
}

// Returns the number of values in the shape's vertexProperty (Inventor); if it has none,
// `in_state`, the number of values in the action's state.
std::int64_t numberOr(const SoShape& shape, const char* values, std::int64_t in_state) {
  const std::int64_t own = numberIn(shape, "vertexProperty", values).value_or(0);
  return own > 0 ? own : in_state;
}

bool isVrml97(const SoShape& shape) { return shape.getField("coord") != nullptr; }

// Describes to which elements of a shape with coordIndex the values of an array belong.
enum class Per { kNothing, kCorner, kFace, kTriangle };

// An array of values that a shape uses.
struct Values {
  std::string_view what;
  std::int64_t there = 0;
  Per per = Per::kNothing;
  const char* indices = "";     // name of the field with their own indices
  bool as_coordinates = false;  // true: without own indices they use coordIndex
};

std::int64_t coordinatesOf(const SoCallbackAction& action, const SoShape& shape) {
  if (isVrml97(shape)) return numberIn(shape, "coord", "point").value_or(0);
  return numberOr(shape, "vertex", action.getNumCoordinates());
}

Values coloursOfVrml97(const SoShape& shape) {
  const auto there = numberIn(shape, "color", "color");
  const auto* const corners = fieldOf<SoSFBool>(&shape, "colorPerVertex");
  if (!there || !corners) return {};
  return {"colours", *there, corners->getValue() ? Per::kCorner : Per::kFace, "colorIndex", true};
}

// Returns the colours of a shape. If they have no indices, any number of colours is valid, since
// the reader uses the last colour for the remaining corners.
Values coloursOf(const SoCallbackAction& action, const SoShape& shape) {
  if (isVrml97(shape)) return coloursOfVrml97(shape);
  const bool strips = shape.isOfType(SoIndexedTriangleStripSet::getClassTypeId());
  const bool faces = shape.isOfType(SoIndexedFaceSet::getClassTypeId());
  if (!strips && !faces) return {};  // colours of lines are not used
  const std::int64_t in_state = SoLazyElement::getInstance(action.getState())->getNumDiffuse();
  Values values{"materials", numberOr(shape, "orderedRGBA", in_state), Per::kNothing,
                "materialIndex"};
  const auto* const own = fieldOf<SoSFNode>(&shape, "vertexProperty");
  const auto* const property =
      static_cast<const SoVertexProperty*>(own ? own->getValue() : nullptr);
  const int binding = property && property->orderedRGBA.getNum() > 0
                          ? property->materialBinding.getValue()
                          : static_cast<int>(action.getMaterialBinding());
  if (binding == SoMaterialBinding::PER_VERTEX_INDEXED) values.per = Per::kCorner;
  if (binding == SoMaterialBinding::PER_PART_INDEXED) values.per = Per::kFace;
  if (binding == SoMaterialBinding::PER_FACE_INDEXED)
    values.per = strips ? Per::kTriangle : Per::kFace;
  return values;
}

Values texcoordsOf(const SoCallbackAction& action, const SoShape& shape) {
  if (isVrml97(shape)) {
    const auto there = numberIn(shape, "texCoord", "point");
    return there ? Values{"texture coordinates", *there, Per::kCorner, "texCoordIndex", true}
                 : Values{};
  }
  // Without a texture, the state's coordinates may be another shape's, so they are not checked.
  SbVec2s size;
  int components = 0;
  if (!action.getTextureImage(size, components)) return {};
  const std::int64_t in_state = action.getNumTextureCoordinates();
  const std::int64_t there = numberOr(shape, "texCoord", numberOr(shape, "texCoord3", in_state));
  if (there == 0) return {};  // texture coordinates are generated
  return {"texture coordinates", there, Per::kCorner, "textureCoordIndex", true};
}

Error beyond(const char* field, std::int64_t index, const Values& values) {
  return malformed(
      fmt::format("its {} has {}, and there are {} {}", field, index, values.there, values.what));
}

// Checks that each corner has a valid index into these values. `field`: name of the indices, for
// messages.
Result<Ok> checkCorners(Indices corners, const Values& values, const char* field, Indices indices) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (corners[i] < 0) continue;  // the end of a face
    if (i >= indices.size())
      return malformed(fmt::format("its {} has {} entries, and coordIndex has {}", field,
                                   indices.size(), corners.size()));
    if (indices[i] < 0 || indices[i] >= values.there) return beyond(field, indices[i], values);
  }
  return Ok{};
}

// Counts the faces of coordIndex, or the triangles of its strips.
std::int64_t facesIn(Indices corners, Per per) {
  std::int64_t faces = 0, length = 0;
  for (std::size_t i = 0; i <= corners.size(); ++i) {
    if (i < corners.size() && corners[i] >= 0) {
      ++length;
      continue;
    }
    if (length > 0) faces += per == Per::kTriangle ? std::max<std::int64_t>(length - 2, 0) : 1;
    length = 0;
  }
  return faces;
}

Result<Ok> checkFaces(Indices corners, const Values& values, Indices indices) {
  const std::int64_t faces = facesIn(corners, values.per);
  if (indices.empty()) {
    if (!values.as_coordinates && faces > 0)  // Coin would read beyond the end of an empty array
      return malformed(fmt::format("it has no {}, which its MaterialBinding needs for its {} faces",
                                   values.indices, faces));
    if (faces <= values.there) return Ok{};
    return malformed(
        fmt::format("it has {} faces, and there are {} {}", faces, values.there, values.what));
  }
  if (faces > static_cast<std::int64_t>(indices.size()))
    return malformed(fmt::format("its {} has {} entries, and it has {} faces", values.indices,
                                 indices.size(), faces));
  for (std::int64_t i = 0; i < faces; ++i) {
    const std::int32_t index = indices[static_cast<std::size_t>(i)];
    if (index < 0 || index >= values.there) return beyond(values.indices, index, values);
  }
  return Ok{};
}

Result<Ok> checkValues(const SoShape& shape, Indices corners, const Values& values) {
  if (values.per == Per::kNothing) return Ok{};
  const Indices indices = indicesOf(shape, values.indices);
  if (values.per != Per::kCorner) return checkFaces(corners, values, indices);
  if (!indices.empty()) return checkCorners(corners, values, values.indices, indices);
  return values.as_coordinates ? checkCorners(corners, values, "coordIndex", corners) : Ok{};
}

// Rejects a face of fewer than three corners: in VRML 97, Coin uses its first three entries
// unchecked; in Inventor, Coin leaves out the rest of the shape. The last two entries of the array
// do not matter.
Result<Ok> checkLengths(const SoShape& shape, Indices corners) {
  if (!shape.isOfType(SoVRMLIndexedFaceSet::getClassTypeId()) &&
      !shape.isOfType(SoIndexedFaceSet::getClassTypeId()))
    return Ok{};
  for (std::size_t begin = 0; begin + 2 < corners.size();) {
    const auto end = std::find_if(corners.begin() + static_cast<std::ptrdiff_t>(begin),
                                  corners.end(), [](std::int32_t index) { return index < 0; });
    const auto at = static_cast<std::size_t>(end - corners.begin());
    if (at < begin + 3)
      return malformed(fmt::format("its coordIndex has a face of {} corners", at - begin));
    begin = at + 1;
  }
  return Ok{};
}

Result<Ok> checkIndexed(const SoCallbackAction& action, const SoShape& shape,
                        const SoMFInt32& field) {
  const Indices corners(field.getValues(0), static_cast<std::size_t>(field.getNum()));
  const Values coordinates{"coordinates", coordinatesOf(action, shape), Per::kCorner};
  if (const auto good = checkCorners(corners, coordinates, "coordIndex", corners); !good)
    return good;
  if (const auto good = checkLengths(shape, corners); !good) return good;
  if (const auto good = checkValues(shape, corners, coloursOf(action, shape)); !good) return good;
  return checkValues(shape, corners, texcoordsOf(action, shape));
}

// Returns the number of corners that a shape uses, from the first one on; nothing if it uses all
// corners.
Result<std::optional<std::int64_t>> cornersOf(const SoShape& shape) {
  if (const auto* const points = fieldOf<SoSFInt32>(&shape, "numPoints"))
    return points->getValue() < 0 ? std::nullopt : std::optional<std::int64_t>(points->getValue());
  if (const auto* const mesh = dynamic_cast<const SoQuadMesh*>(&shape))
    return std::optional(std::int64_t{mesh->verticesPerRow.getValue()} *
                         mesh->verticesPerColumn.getValue());
  const auto* const numbers = fieldOf<SoMFInt32>(&shape, "numVertices");
  if (!numbers) return std::optional<std::int64_t>();
  if (numbers->getNum() == 1 && (*numbers)[0] == -1) return std::optional<std::int64_t>();
  std::int64_t sum = 0;
  for (int i = 0; i < numbers->getNum(); ++i) {
    if ((*numbers)[i] < 0)
      return malformed(fmt::format(
          "its numVertices has {} beside other values; -1 is allowed alone", (*numbers)[i]));
    sum += (*numbers)[i];
  }
  return std::optional(sum);
}

Result<Ok> checkConsecutive(const SoCallbackAction& action, const SoShape& shape) {
  const auto* const start = fieldOf<SoSFInt32>(&shape, "startIndex");
  if (!start) return Ok{};  // a sphere and the like
  const auto corners = cornersOf(shape);
  if (!corners) return corners.error();
  const std::int64_t first = start->getValue(), coordinates = coordinatesOf(action, shape);
  const std::int64_t end = *corners ? first + **corners : std::max(first, coordinates);
  if (first < 0) return malformed(fmt::format("its startIndex is {}", first));
  if (end > coordinates)
    return malformed(fmt::format("it takes {} coordinates, and there are {}", end, coordinates));
  const Values texcoords = texcoordsOf(action, shape);
  if (texcoords.per == Per::kNothing || end <= texcoords.there) return Ok{};
  return malformed(
      fmt::format("it takes {} texture coordinates, and there are {}", end, texcoords.there));
}

Result<Ok> checkGrid(const SoVRMLElevationGrid& grid) {
  const std::int64_t x = grid.xDimension.getValue(), z = grid.zDimension.getValue();
  if (x < 2 || z < 2) return Ok{};  // no surface
  const auto check = [](std::string_view what, std::optional<std::int64_t> there,
                        std::int64_t wanted) -> Result<Ok> {
    if (!there || *there >= wanted) return Ok{};
    return malformed(fmt::format("it takes {} {}, and there are {}", wanted, what, *there));
  };
  const auto per = [&](const SoSFBool& corner) {
    return corner.getValue() ? x * z : (x - 1) * (z - 1);
  };
  for (const auto& good :
       {check("heights", grid.height.getNum(), x * z),
        check("colours", numberIn(grid, "color", "color"), per(grid.colorPerVertex)),
        check("normals", numberIn(grid, "normal", "vector"), per(grid.normalPerVertex)),
        check("texture coordinates", numberIn(grid, "texCoord", "point"), x * z)}) {
    if (!good) return good;
  }
  return Ok{};
}

}  // namespace

Result<Ok> checkIndices(const SoCallbackAction& action, const SoShape& shape) {
  if (const auto* const grid = dynamic_cast<const SoVRMLElevationGrid*>(&shape))
    return checkGrid(*grid);
  if (const auto* const indices = fieldOf<SoMFInt32>(&shape, "coordIndex"))
    return checkIndexed(action, shape, *indices);
  return checkConsecutive(action, shape);
}

}  // namespace merlin::render::import
