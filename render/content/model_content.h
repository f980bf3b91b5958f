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

namespace merlin::render {

// A dendrogram's levels, and triangles as their cost. The dendrogram is borrowed.
class ModelDetail final : public DetailAxis {
 public:
  explicit ModelDetail(const Dendrogram& model) noexcept : model_(model) {}

  std::size_t steps() const noexcept override { return model_.levels(); }
  std::size_t costOf(std::size_t step) const noexcept override { return model_.trianglesAt(step); }
  std::size_t stepWithin(std::size_t budget) const noexcept override {
    return model_.levelFor(budget);
  }
  std::size_t leastUseful() const noexcept override { return 300; }
  std::string_view unit() const noexcept override { return "triangles"; }

 private:
  const Dendrogram& model_;
};

// Triangles of one draw call, in the order of their index buffer.
struct TriangleRun {
  std::size_t first = 0, count = 0;
};

// Parts of a model that are drawn in all views of a frame. One for all contexts, which only read
// it.
struct ModelDrawList {
  bool full = false;                           // the full resolution's triangles, else `cut`
  std::span<const std::uint32_t> cut{};        // node numbers, 3 a triangle
  std::span<const Morph> morphs{};             // of the cut's vertices
  std::vector<ContentView> views;              // by number of the tile
  std::vector<std::vector<TriangleRun>> runs;  // what each of them sees, likewise
};

class ModelContent final : public Content {
 public:
  // On any thread. The model is borrowed; it is scaled to a bounding sphere of `radius_m` about the
  // middle of its box. Errors: kMalformed (its texture cannot be read), those of coloursOf().
  // O(nodes + triangles).
  static Result<std::unique_ptr<ModelContent>> make(const Dendrogram& model,
                                                    const ModelSettings& settings, double radius_m);

  const DetailAxis& detail() const noexcept override { return detail_; }
  ContentBounds bounds() const noexcept override { return {radius_m_, T_content_box_}; }
  Navigation navigation() const noexcept override { return Navigation::kObject; }
  void choose(std::size_t step, std::span<const ContentView> views) override;
  Result<std::unique_ptr<ContentRenderer>> attach(const GlApi& gl) const override;
  void attached() noexcept override { upload_.reset(); }

 private:
  ModelContent(const Dendrogram& model, const ModelSettings& settings, float radius_m);
  std::size_t cutTo(std::size_t level, bool uneven);
  void chooseRuns(std::size_t view, std::vector<TriangleRun>& runs) const;

  const Dendrogram& model_;
  ModelDetail detail_;
  ModelSettings settings_;
  float radius_m_;
  Eigen::Matrix4f metres_from_model_;  // scales and centres the model
  Eigen::Matrix4f T_content_box_;
  Clusters clusters_;
  ViewCut view_cut_;
  std::vector<std::uint32_t> full_ends_;  // where clusters end in the full resolution, triangles
  // Data that the renderers upload once; kept until they have done so.
  struct Upload {
    std::vector<std::uint32_t> full;  // the full resolution, node numbers, 3 a triangle
    ImageFile texture;
  };
  std::unique_ptr<Upload> upload_;
  // The cut: its triangles, where clusters end in them if it is clustered, and every cluster's
  // level where all have the same.
  std::vector<std::uint32_t> cut_, cut_ends_, even_levels_;
  std::vector<Morph> morphs_;
  bool clustered_ = false;
  std::vector<TileView> tile_views_;
  ModelDrawList list_;
};

}  // namespace merlin::render
