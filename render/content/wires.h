// Wires: draws triangles as wireframe in one colour, with hidden edges removed.
#pragma once

#include <array>
#include <functional>

#include <Eigen/Core>

#include "daemon/base/result.h"
#include "render/content/settings.h"
#include "render/gl/gl_api.h"

namespace merlin::render::content {

// Thread-bound to its context, which must outlive it.
class Wires {
 public:
  explicit Wires(const gl::GlApi& gl) : gl_(gl) {}
  ~Wires() { gl_.DeleteProgram(program_); }
  Wires(const Wires&) = delete;
  Wires& operator=(const Wires&) = delete;

  // Compiles the shaders; call once, before draw(). Errors: kUnsupported, with the compiler's log.
  Result<Ok> build();

  // Calls `triangles` twice: to draw faces in the background colour, which hide what is behind
  // them, then to draw edges in the model's colour. `triangles` issues the draw call; vertex
  // positions are attribute 0.
  void draw(const Eigen::Matrix4f& clip_from_model, const RenderStyle& style,
            const std::function<void()>& triangles) const;

 private:
  void setColour(const std::array<float, 3>& rgb) const;

  const gl::GlApi& gl_;
  GLuint program_ = 0;
  GLint clip_location_ = -1, colour_location_ = -1;
};

}  // namespace merlin::render::content
