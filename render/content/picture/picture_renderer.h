// PictureRenderer: draws what PictureContent chose in one OpenGL context, from textures that hold
// its tiles: each texture is an array of kSlotsPerTexture slots of the cache, and is created when
// one of its slots is first filled.
#pragma once

#include <memory>
#include <vector>

#include "render/content/content.h"
#include "render/content/picture/tile_cache.h"
#include "render/gl/gl_api.h"

namespace merlin::render::content {

struct PictureDrawList;

class PictureRenderer final : public ContentRenderer {
 public:
  // `list` and `cache` must outlive it. Errors: kUnsupported (a shader does not compile, with the
  // log).
  static Result<std::unique_ptr<ContentRenderer>> make(const gl::GlApi& gl,
                                                       const PictureDrawList& list,
                                                       TileCache& cache);
  ~PictureRenderer() override;
  PictureRenderer(const PictureRenderer&) = delete;
  PictureRenderer& operator=(const PictureRenderer&) = delete;

  void beginFrame() override;
  void beginView(std::size_t tile, int width, int height) override;
  bool drawSlice(std::size_t tile, DrawProgress& progress) override;

 private:
  PictureRenderer(const gl::GlApi& gl, const PictureDrawList& list, TileCache& cache,
                  GLuint program);
  bool uploadSome(std::size_t most);
  void upload(std::size_t slot);
  void uploadBorder(std::size_t slot, const TileBorder& border);
  void bindTexture(std::size_t texture);

  const gl::GlApi& gl_;
  const PictureDrawList& list_;
  TileCache& cache_;
  UploadedVersions& uploaded_;
  GLuint program_, array_ = 0, vertices_ = 0, indices_ = 0;
  GLint clip_location_ = -1, layer_location_ = -1;
  std::vector<GLuint> textures_;
  std::size_t looked_at_ = 0;  // slots that were checked in this frame
};

}  // namespace merlin::render::content
