// ModelRenderer: uploads the nodes of a dendrogram to the GPU and draws its triangles at any level,
// at once or in slices.
//
// Lighting is per vertex, from a light close to the eye; it modulates the model's texture, its
// colours or the feature shown as colours. OpenGL 3.3 core. Thread-bound to its context, which must
// outlive it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "daemon/base/result.h"
#include "render/content/settings.h"
#include "render/content/shown_colours.h"
#include "render/content/wires.h"
#include "render/gl/gl_api.h"
#include "render/gl/texture.h"
#include "render/lod/dendrogram.h"
#include "render/lod/geomorph.h"

namespace merlin::render::content {

// Camera of one tile.
struct Camera {
  Eigen::Matrix4f clip_from_model;  // OpenGL's clip space, y up; y is negated when drawn
  Eigen::Matrix3f eye_from_model;   // rotation only, for the light
};

class ModelRenderer {
 public:
  // Uploads the nodes (20 bytes each) and `full`, the indices of the full resolution in drawing
  // order, which may be freed afterwards. The model must outlive the renderer. `show`: the feature
  // shown as colours. `texture`: used if no feature is named and the model has a feature "texcoord"
  // of dimension 2; its coordinates refer to this image. Errors: kUnsupported (a shader does not
  // compile, with the log; not enough GPU memory), those of coloursOf().
  static Result<std::unique_ptr<ModelRenderer>> make(const gl::GlApi& gl,
                                                     const lod::Dendrogram& model,
                                                     std::span<const std::uint32_t> full,
                                                     const ShownFeature& show = {},
                                                     const gl::TextureImage* texture = nullptr);

  ~ModelRenderer();
  ModelRenderer(const ModelRenderer&) = delete;
  ModelRenderer& operator=(const ModelRenderer&) = delete;

  // Uploads the triangles of kCut: node numbers, 3 per triangle. Replaces the previous cut.
  void uploadCut(std::span<const std::uint32_t> indices);

  // Displaces these nodes, in ascending order of their numbers as morphsAt() returns them; all
  // other nodes return to their own positions. O(nodes displaced before and now). REQUIRES: all
  // drawing has finished (after finish() or a read-back).
  void morph(std::span<const lod::Morph> morphs);

  enum class Source { kCut, kFull };
  std::size_t triangles(Source source) const noexcept {
    return source == Source::kCut ? cut_triangles_ : full_triangles_;
  }

  // Clears the bound render target (width x height pixels) and sets up the OpenGL state and the
  // camera.
  void begin(int width, int height, const Camera& camera, const RenderStyle& style);

  // Draws triangles first .. first + count - 1; to be called after begin(). May be called several
  // times, for slices; a flush() between slices bounds the time of each.
  void draw(Source source, std::size_t first, std::size_t count);

  void flush() { gl_.Flush(); }    // starts the execution of the commands so far
  void finish() { gl_.Finish(); }  // waits until all of them are executed

 private:
  struct Vertex;

  // The range of the texture coordinates u and v.
  struct Range {
    float low[2] = {0, 0}, size[2] = {1, 1};
  };

  ModelRenderer(const gl::GlApi& gl, const lod::Dendrogram& model);
  void useTexture(const lod::FeatureView& texcoord, const gl::TextureImage& image);
  Result<Ok> buildProgram();
  Vertex vertexOf(std::uint32_t node) const;
  Vertex parentOf(std::uint32_t node) const;
  Vertex between(const Vertex& parent, const Vertex& own, float share) const;
  void uploadNodes();
  void makeArray(GLuint* array, GLuint* indices);

  const gl::GlApi& gl_;
  const lod::Dendrogram& model_;
  const lod::FeatureView* normal_ = nullptr;
  ShownColours colours_;
  const lod::FeatureView* texcoord_ = nullptr;  // set if texture_ is
  Range texcoords_;
  std::unique_ptr<gl::Texture> texture_;
  GLuint program_ = 0, nodes_ = 0;
  Wires wires_;
  // The style passed to begin().
  RenderStyle style_;
  Eigen::Matrix4f clip_ = Eigen::Matrix4f::Identity();
  GLuint cut_array_ = 0, cut_indices_ = 0, full_array_ = 0, full_indices_ = 0;
  GLint clip_location_ = -1, eye_location_ = -1, colour_location_ = -1, range_location_ = -1;
  // Nodes that are displaced now, and their displaced vertices.
  std::vector<lod::Morph> morphs_;
  std::vector<Vertex> morphed_;
  std::size_t cut_triangles_ = 0, full_triangles_ = 0;
};

}  // namespace merlin::render::content
