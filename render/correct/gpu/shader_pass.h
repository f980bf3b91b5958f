// ShaderPass: evaluates the formula of correction_map.h in an OpenGL context, as a shader. Its
// signals differ from the CPU's by at most 1 of 255.
#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/dma_buf.h"
#include "daemon/base/result.h"
#include "render/correct/correction_pass.h"
#include "render/gl/data_texture.h"
#include "render/gl/gl_context.h"
#include "render/gl/read_back.h"
#include "render/gl/render_target.h"

namespace merlin::render::correct {

// Serves all outputs of a wall. It is off at first: run() returns false. Thread-bound to the
// context of begin(), except fault() and drawFault().
class ShaderPass final : public CorrectionPass {
 public:
  ShaderPass() = default;
  ~ShaderPass() override;
  ShaderPass(const ShaderPass&) = delete;
  ShaderPass& operator=(const ShaderPass&) = delete;

  // From now on run() draws in `context`, which must be current and outlive end(). Errors:
  // kUnsupported (the shader does not compile), with OpenGL's message.
  // `draws`: whether draw() may draw into displays' memory.
  Result<Ok> begin(const gl::GlContext& context, bool draws = true);
  // Switches the pass off again. Call it before the context is destroyed.
  void end();

  // The first call with a map creates its textures and its render target: about 20 bytes for each
  // pixel. The textures of maps that nobody holds any more are deleted.
  bool run(const std::shared_ptr<const CorrectionMap>& map, std::span<const std::uint8_t> picture,
           std::span<std::uint8_t> signal) override;

  bool canDraw() const override { return gl_ && draws_; }
  // The first call with a buffer imports it, draws there, and compares the result with a picture
  // drawn into a render target, which costs two read-backs; if the signal was black, the next call
  // compares again. Buffers that nobody holds any more are released, also by run(). A buffer that
  // the context refuses, or that held another picture than was drawn, is not tried again.
  bool draw(const std::shared_ptr<const CorrectionMap>& map, std::span<const std::uint8_t> picture,
            std::span<const out::DrawPlace> places, std::span<const int> rows,
            std::span<std::uint8_t> signal) override;

  // Returns why the memory of a display was refused, while somebody still holds that memory; empty:
  // none was refused. Thread-safe.
  std::string drawFault() const;

  // Returns why the pass cannot compute a map's signal although it is on, for example that an
  // output is larger than OpenGL's textures, while somebody still holds that map; empty: no map was
  // refused. A reset of the GPU is not reported here (see GlContext::wasReset()). Thread-safe.
  std::string fault() const;

 private:
  // The textures of one map, in the order of kSamplers, and the target into which its signal is
  // drawn.
  struct Tables {
    std::weak_ptr<const CorrectionMap> map;
    std::vector<gl::DataTexture> textures;
    gl::RenderTarget signal;
  };
  // A display's memory, and the render target that it is; no target if the memory was refused.
  struct Lent {
    std::weak_ptr<const DmaBuf> buffer;
    std::optional<gl::RenderTarget> target{};
    bool is_right = false;  // a picture that was not black was drawn there and read back correctly
    std::string fault{};    // why it was refused
  };
  // A map for which no textures could be made.
  struct Refused {
    std::weak_ptr<const CorrectionMap> map;
    std::string fault{};
  };
  Result<Tables> makeTables(const std::shared_ptr<const CorrectionMap>& map) const;
  Result<Tables*> tablesOf(const std::shared_ptr<const CorrectionMap>& map);
  Tables* tablesUnlessRefused(const std::shared_ptr<const CorrectionMap>& map);
  void releaseUnheld();
  Lent* lentOf(const std::shared_ptr<const DmaBuf>& buffer);
  bool isDrawnRight(Lent& lent, const out::DrawPlace& place, const Tables& tables,
                    const CorrectionMap& map);
  void setLight(const Light& light) const;
  void drawAt(const gl::RenderTarget& target, int x, int y, const Tables& tables,
              const CorrectionMap& map) const;
  void readRows(const gl::RenderTarget& target, const out::DrawPlace& place, int width,
                std::span<const int> rows, std::span<std::uint8_t> signal);
  void tellFaults();

  const gl::GlContext* context_ = nullptr;
  const gl::GlApi* gl_ = nullptr;  // null: off
  bool draws_ = false;
  GLuint program_ = 0, vertices_ = 0;
  std::list<Tables> tables_;
  std::list<Refused> refused_;
  std::list<Lent> lent_;
  std::optional<gl::ReadBack> row_reader_;
  std::vector<std::uint8_t> row_pixels_;
  mutable std::mutex mutex_;  // guards the next two
  std::string fault_, draw_fault_;
};

}  // namespace merlin::render::correct
