// Surface: what the fields of an SoMRFaceSet describe, checked, and two resolutions cut from it.
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

namespace merlin::render {

// Keeps copies of the fields: whatever becomes of them afterwards, a cut stays safe. Thread-bound.
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

  // Two are kept, so that one is swapped for the other at once ([GOURLEY98] 5.4).
  enum Copy { kStill, kMoving };

  // Checks all that a cut relies on, O(fields). Errors: kMalformed.
  static Result<std::unique_ptr<Surface>> make(const Fields& fields);
  ~Surface();
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  // The copy at the finest resolution with at most `budget` triangles, cut now where it had
  // another; the coarsest where none is that small. Valid for as long as the surface.
  SoIndexedFaceSet& at(Copy copy, std::size_t budget);

  // Number of triangles of that cut: O(log levels), cuts nothing.
  std::size_t trianglesFor(std::size_t budget) const noexcept;

  SoVertexProperty& attributes() const noexcept { return *attributes_; }  // of all nodes
  const SbBox3f& box() const noexcept { return box_; }                    // of all nodes

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
  std::unique_ptr<const Dendrogram> dendrogram_;
  SbBox3f box_;
};

}  // namespace merlin::render
