// Surface: the model that the fields of an SoMRFaceSet describe, after a check, and two cuts of it.
#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include <Inventor/SbBox.h>
#include <Inventor/fields/SoMFColor.h>
#include <Inventor/fields/SoMFFloat.h>
#include <Inventor/fields/SoMFInt32.h>
#include <Inventor/fields/SoMFVec2f.h>
#include <Inventor/fields/SoMFVec3f.h>
#include <Inventor/nodes/SoIndexedFaceSet.h>
#include <Inventor/nodes/SoVertexProperty.h>

#include "daemon/base/result.h"
#include "render/lod/dendrogram.h"

namespace merlin::render::inventor {

// Keeps copies of the fields, so that cuts stay valid if the fields change. Thread-bound.
class Surface {
 public:
  struct Fields {
    const SoMFVec3f& vertex;
    const SoMFVec3f& normal;
    const SoMFColor& diffuseColor;
    const SoMFVec2f& texCoord;
    const SoMFInt32& faces;
    const SoMFInt32& parents;
    const SoMFInt32& aliveCounts;
    const SoMFFloat& levelErrors;
  };

  // Names of the two cuts that are kept, one for rest and one for motion, so that a change between
  // these is immediate ([GOURLEY98] 5.4).
  enum Copy { kStill, kMoving };

  // Makes a surface. Checks everything that a cut relies on, in O(fields). Errors: kMalformed.
  static Result<std::unique_ptr<Surface>> make(const Fields& fields);
  ~Surface();
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  // Returns the face set of `copy` at the finest resolution with at most `budget` triangles, or at
  // the coarsest resolution if none has so few. Cuts again only if the level differs from that of
  // the last call. Valid as long as this object.
  SoIndexedFaceSet& at(Copy copy, std::size_t budget);

  // Returns the number of triangles that at() would return, without cutting. O(log levels).
  std::size_t trianglesFor(std::size_t budget) const noexcept;

  SoVertexProperty& attributes() const noexcept { return *attributes_; }  // attributes of all nodes
  // Bounding box of all nodes.
  const SbBox3f& box() const noexcept { return box_; }

 private:
  struct Cut {
    SoIndexedFaceSet* faces = nullptr;
    std::size_t level = 0;
    bool made = false;
  };

  explicit Surface(const Fields& fields);
  Result<Ok> check(const Fields& fields);
  void cut(Cut& copy, std::size_t level) const;

  SoVertexProperty* attributes_;
  std::array<Cut, 2> copies_;
  std::unique_ptr<const lod::Dendrogram> dendrogram_;
  SbBox3f box_;
};

}  // namespace merlin::render::inventor
