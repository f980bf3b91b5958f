// ShaderPass: evaluates the formula of correction_map.h in an OpenGL context, as a shader. Its
// signals differ from the CPU's by at most 1 of 255.
#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "render/correct/correction_pass.h"
#include "render/gl/data_texture.h"
#include "render/gl/gl_context.h"
#include "render/gl/render_target.h"

namespace merlin::render::correct {

// Serves all outputs of a wall. It is off at first: run() returns false. Thread-bound to the
// context of begin(), except fault().
class ShaderPass final : public CorrectionPass {
 public:
  ShaderPass() = default;
  ~ShaderPass() override;
  ShaderPass(const ShaderPass&) = delete;
  ShaderPass& operator=(const ShaderPass&) = delete;

  // From now on run() draws in `context`, which must be current and outlive end(). Errors:
  // kUnsupported (the shader does not compile), with OpenGL's message.
  Result<Ok> begin(const gl::GlContext& context);
  // Switches the pass off again. Call it before the context is destroyed.
  void end();

  // The first call with a map creates its textures: 24 bytes for each pixel. The textures of maps
  // that nobody holds any more are deleted.
  bool run(const std::shared_ptr<const CorrectionMap>& map, std::span<const std::uint8_t> picture,
           std::span<std::uint8_t> signal) override;

  // Why run() last returned false although it is on, for example because an output is larger than
  // OpenGL's textures; empty: it has not. Thread-safe.
  std::string fault() const;

 private:
  // One map's textures, in the order of kSamplers, and where its signal is drawn.
  struct Tables {
    std::weak_ptr<const CorrectionMap> map;
    std::vector<gl::DataTexture> textures;
    gl::RenderTarget signal;
  };
  Result<Tables> makeTables(const std::shared_ptr<const CorrectionMap>& map) const;
  Result<Tables*> tablesOf(const std::shared_ptr<const CorrectionMap>& map);
  void setLight(const Light& light) const;
  void draw(const Tables& tables, const CorrectionMap& map) const;

  const gl::GlApi* gl_ = nullptr;  // null: off
  GLuint program_ = 0, vertices_ = 0;
  std::list<Tables> tables_;
  std::list<std::weak_ptr<const CorrectionMap>> refused_;  // maps that it cannot compute
  mutable std::mutex mutex_;                               // guards fault_
  std::string fault_;
};

}  // namespace merlin::render::correct
