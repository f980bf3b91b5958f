// ModelRenderer: a dendrogram's nodes on the GPU, and its triangles drawn at any level, whole or in
// slices.
//
// Lit per vertex by a light at the eye, which modulates the model's texture, its colours, or a
// feature that is shown. OpenGL 3.3 core. Thread-bound to its context, which outlives it.
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

namespace merlin::render {

// Camera of one tile.
struct Camera {
  Eigen::Matrix4f clip_from_model;  // y up, OpenGL's clip space; y is turned over when drawn
  Eigen::Matrix3f eye_from_model;   // rotation only, for the light
};

class ModelRenderer {
 public:
  // Uploads the nodes (20 bytes each) and the full resolution's indices, in the order in which they
  // are to be drawn, which it does not keep; borrows the model. `show`: what is seen as colours.
  // `texture`: the picture that the model's "texcoord" is of, seen where nothing else is shown and
  // the model has such a feature of dimension 2.
  // Errors: kUnsupported (a shader that does not compile, with the log; no memory on the GPU),
  // those of coloursOf().
  static Result<std::unique_ptr<ModelRenderer>> make(const GlApi& gl, const Dendrogram& model,
                                                     std::span<const std::uint32_t> full,
                                                     const ShownFeature& show = {},
                                                     const TextureImage* texture = nullptr);

  ~ModelRenderer();
  ModelRenderer(const ModelRenderer&) = delete;
  ModelRenderer& operator=(const ModelRenderer&) = delete;

  // Node numbers, 3 a triangle, for kCut. Replaces the last ones.
  void uploadCut(std::span<const std::uint32_t> indices);

  // Where nodes stand from now on; all others, at their own place. By rising number, as morphsAt()
  // gives them. O(what was and what is on its way). REQUIRES: nothing drawn is still under way
  // (finish(), or read back).
  void morph(std::span<const Morph> morphs);

  enum class Source { kCut, kFull };
  std::size_t triangles(Source source) const noexcept {
    return source == Source::kCut ? cut_triangles_ : full_triangles_;
  }

  // Clears the bound frame buffer's picture of width x height and sets up state and camera.
  void begin(int width, int height, const Camera& camera, const RenderStyle& style);

  // Draws triangles first .. first + count - 1, after begin(). May be called in slices: a flush
  // between slices bounds how long one takes.
  void draw(Source source, std::size_t first, std::size_t count);

  void flush() { gl_.Flush(); }    // lets what was drawn begin
  void finish() { gl_.Finish(); }  // waits until it is done

 private:
  struct Vertex;

  // A range of texture coordinates, by axis.
  struct Range {
    float low[2] = {0, 0}, size[2] = {1, 1};
  };

  ModelRenderer(const GlApi& gl, const Dendrogram& model);
  void useTexture(const FeatureView& texcoord, const TextureImage& image);
  Result<Ok> buildProgram();
  Vertex vertexOf(std::uint32_t node) const;
  Vertex parentOf(std::uint32_t node) const;
  Vertex between(const Vertex& parent, const Vertex& own, float share) const;
  void uploadNodes();
  void makeArray(GLuint* array, GLuint* indices);

  const GlApi& gl_;
  const Dendrogram& model_;
  const FeatureView* normal_ = nullptr;
  ShownColours colours_;
  const FeatureView* texcoord_ = nullptr;  // with texture_
  Range texcoords_;
  std::unique_ptr<Texture> texture_;
  GLuint program_ = 0, nodes_ = 0;
  Wires wires_;
  // Style given to begin().
  RenderStyle style_;
  Eigen::Matrix4f clip_ = Eigen::Matrix4f::Identity();
  GLuint cut_array_ = 0, cut_indices_ = 0, full_array_ = 0, full_indices_ = 0;
  GLint clip_location_ = -1, eye_location_ = -1, colour_location_ = -1, range_location_ = -1;
  // That stand elsewhere now, and where.
  std::vector<Morph> morphs_;
  std::vector<Vertex> morphed_;
  std::size_t cut_triangles_ = 0, full_triangles_ = 0;
};

}  // namespace merlin::render
