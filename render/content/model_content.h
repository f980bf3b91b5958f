// ModelContent: a multiresolution model as a content. Its detail steps are the dendrogram's levels.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "render/content/content.h"
#include "render/content/settings.h"
#include "render/image/image_file.h"
#include "render/lod/clusters.h"
#include "render/lod/dendrogram.h"
#include "render/lod/geomorph.h"
#include "render/lod/view_cut.h"

namespace merlin::render::content {

// The levels of a dendrogram as detail steps, with their triangle counts as costs. The dendrogram
// must outlive it.
class ModelDetail final : public DetailAxis {
 public:
  explicit ModelDetail(const lod::Dendrogram& model) noexcept : model_(model) {}

  std::size_t steps() const noexcept override { return model_.levels(); }
  std::size_t costOf(std::size_t step) const noexcept override { return model_.trianglesAt(step); }
  std::size_t stepWithin(std::size_t budget) const noexcept override {
    return model_.levelFor(budget);
  }
  std::size_t leastUseful() const noexcept override { return 300; }
  std::string_view unit() const noexcept override { return "triangles"; }

 private:
  const lod::Dendrogram& model_;
};

// Triangles of one draw call, in the order of their index buffer.
struct TriangleRun {
  std::size_t first = 0, count = 0;
};

// What is drawn of a model in all views of a frame. All contexts share and only read it.
struct ModelDrawList {
  bool full = false;                     // draw the triangles of the full resolution, else `cut`
  std::span<const std::uint32_t> cut{};  // node numbers, 3 a triangle
  std::span<const lod::Morph> morphs{};  // displaced vertices of the cut
  std::vector<ContentView> views;        // by tile number
  std::vector<std::vector<TriangleRun>> runs;  // triangles that each view may see, by tile number
};

class ModelContent final : public Content {
 public:
  // Makes a content of a model, which must outlive it; may be called on any thread. The model is
  // scaled such that a sphere of `radius_m` about the centre of its bounding box encloses it.
  // Errors: kMalformed (the model's texture cannot be decoded). O(nodes + triangles).
  static Result<std::unique_ptr<ModelContent>> make(const lod::Dendrogram& model,
                                                    const ModelSettings& settings, double radius_m);

  const DetailAxis& detail() const noexcept override { return detail_; }
  ContentBounds bounds() const noexcept override { return {radius_m_, T_content_box_}; }
  Navigation navigation() const noexcept override { return Navigation::kObject; }
  void choose(std::size_t step, std::span<const ContentView> views) override;
  Result<std::unique_ptr<ContentRenderer>> attach(const gl::GlApi& gl) const override;
  void attached() noexcept override { upload_.reset(); }

 private:
  ModelContent(const lod::Dendrogram& model, const ModelSettings& settings, float radius_m);
  std::size_t cutTo(std::size_t level, bool uneven);
  void chooseRuns(std::size_t view, std::vector<TriangleRun>& runs) const;

  const lod::Dendrogram& model_;
  ModelDetail detail_;
  ModelSettings settings_;
  float radius_m_;
  Eigen::Matrix4f metres_from_model_;  // scales and centres the model
  Eigen::Matrix4f T_content_box_;
  lod::Clusters clusters_;
  lod::ViewCut view_cut_;
  // Index after each cluster's last triangle, in the full resolution.
  std::vector<std::uint32_t> full_ends_;
  // Data that each renderer uploads when it is attached; freed by attached().
  struct Upload {
    std::vector<std::uint32_t> full;  // the full resolution: node numbers, 3 per triangle
    image::ImageFile texture;
  };
  std::unique_ptr<Upload> upload_;
  // The cut: its triangles, the end of each cluster in them (only if clustered_), and the levels
  // passed to Clusters::cut() if all clusters have the same level.
  std::vector<std::uint32_t> cut_, cut_ends_, even_levels_;
  std::vector<lod::Morph> morphs_;
  bool clustered_ = false;
  std::vector<lod::TileView> tile_views_;
  ModelDrawList list_;
};

}  // namespace merlin::render::content
