// Wires: triangles as their edges, in one colour, behind one another as faces would be.
#pragma once

#include <array>
#include <functional>

#include <Eigen/Core>

#include "daemon/base/result.h"
#include "render/content/settings.h"
#include "render/gl/gl_api.h"

namespace merlin::render {

// Thread-bound to its context, which outlives it.
class Wires {
 public:
  explicit Wires(const GlApi& gl) : gl_(gl) {}
  ~Wires() { gl_.DeleteProgram(program_); }
  Wires(const Wires&) = delete;
  Wires& operator=(const Wires&) = delete;

  // Errors: kUnsupported, with the compiler's log.
  Result<Ok> build();

  // Calls `triangles` twice, which draws with the vertices' positions at location 0: as faces of
  // the background's colour, then as edges of the model's.
  void draw(const Eigen::Matrix4f& clip_from_model, const RenderStyle& style,
            const std::function<void()>& triangles) const;

 private:
  void setColour(const std::array<float, 3>& rgb) const;

  const GlApi& gl_;
  GLuint program_ = 0;
  GLint clip_location_ = -1, colour_location_ = -1;
};

}  // namespace merlin::render
