// Reduces a mesh in blocks, which are cut along a space-filling curve. The blocks are reduced one
// after another, with locked borders and the same error limit; the triangles that remain are then
// reduced as one mesh.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "render/mesh/coincident.h"
#include "render/reduce/memory.h"
#include "render/reduce/out_of_core/block_cutter.h"
#include "render/reduce/quadric/quadric.h"

namespace merlin::render::reduce {
namespace {

constexpr std::uint32_t kNoNode = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kSamples = 32;
constexpr std::size_t kSampleSize = 20'000;  // vertices

// Result of one block.
struct Part {
  std::vector<std::uint32_t> vertices;  // by vertex: its index in the whole mesh
  lod::CollapseLog log;
};

class InBlocks {
 public:
  InBlocks(const mesh::Mesh& mesh, const QuadricPlan& plan, const std::vector<bool>& locked,
           std::size_t blocks, const Progress& progress)
      : mesh_(mesh), plan_(plan), locked_(locked), blocks_(blocks), progress_(progress) {
    const double all = static_cast<double>(mesh.triangleCount());
    target_ = static_cast<double>(plan.limits.triangles) / all;
    share_ = shareOfBlocks(target_);
  }

  Reduction run() {
    result_.report.triangles = mesh_.triangleCount();
    std::vector<Part> parts = reduceBlocks();
    join(parts);
    parts = {};
    if (cancelled_)
      result_.report.stopped = "cancelled";
    else
      reduceRest();
    const std::vector<float>& error = result_.log.error;
    result_.report.error = error.empty() ? 0 : *std::max_element(error.begin(), error.end());
    result_.report.collapses = result_.log.children.size();
    return std::move(result_);
  }

 private:
  std::uint32_t vertices() const { return static_cast<std::uint32_t>(mesh_.vertexCount()); }

  // --- blocks ------------------------------------------------------------------------------------

  std::vector<Part> reduceBlocks() {
    const BlockCutter cutter(mesh_, locked_, plan_.limits.threads);
    QuadricPlan plan = plan_;
    plan.limits.by_all_rules = true;
    plan.limits.error = std::min(plan.limits.error, errorForAll(cutter));
    const std::size_t stride = (mesh_.vertexCount() + blocks_ - 1) / blocks_;
    std::vector<Part> parts;
    for (std::size_t b = 0; b < blocks_ && !cancelled_; ++b) {
      Block block = std::move(cutter.cut({stride, stride, b, b}).front());
      if (block.mesh.triangles.empty()) continue;
      plan.limits.triangles = leastOf(block);
      Reduction r = runQuadric(block.mesh, plan, block.locked, progressOf(block));
      addReport(r.report, block.mesh.triangleCount() - r.report.triangles);
      parts.push_back({std::move(block.vertices), std::move(r.log)});
    }
    return parts;
  }

  // Returns the minimum number of triangles that a block keeps, so that a flat block, where
  // collapses cost nothing, is not reduced to its borders.
  std::size_t leastOf(const Block& block) const {
    return static_cast<std::size_t>(std::max(share_ / 2, target_) *
                                    static_cast<double>(block.mesh.triangleCount()));
  }

  // Returns the error limit with which all blocks together keep about the share `share_` of their
  // triangles, so that all blocks become equally coarse. The limit is estimated from samples along
  // the whole curve; it is infinite if the samples cannot be reduced that far.
  float errorForAll(const BlockCutter& cutter) const {
    const std::size_t n = mesh_.vertexCount(), stride = (n + kSamples - 1) / kSamples;
    std::vector<float> errors;
    std::size_t free = 0;
    QuadricPlan plan = plan_;
    plan.limits.by_all_rules = true;
    for (Block& sample : cutter.cut({stride, std::min(stride, kSampleSize), 0, kSamples - 1})) {
      if (sample.mesh.triangles.empty()) continue;
      plan.limits.triangles = leastOf(sample);
      const Reduction r = runQuadric(sample.mesh, plan, sample.locked, {});
      float worst = 0;
      for (const float e : r.log.error) errors.push_back(worst = std::max(worst, e));
      free +=
          static_cast<std::size_t>(std::count(sample.locked.begin(), sample.locked.end(), false));
    }
    const auto wanted = static_cast<std::size_t>((1 - share_) * static_cast<double>(free));
    if (wanted >= errors.size()) return std::numeric_limits<float>::infinity();
    const auto at = errors.begin() + static_cast<std::ptrdiff_t>(wanted);
    std::nth_element(errors.begin(), at, errors.end());
    return *at;
  }

  Progress progressOf(const Block& block) {
    if (!progress_) return {};
    return
        [this, before = result_.report, own = block.mesh.triangleCount()](const ReduceProgress& p) {
          cancelled_ =
              !progress_({before.collapses + p.collapses, before.triangles - (own - p.triangles)});
          return !cancelled_;
        };
  }

  void addReport(const ReduceReport& r, std::size_t removed) {
    ReduceReport& all = result_.report;
    all.collapses += r.collapses;
    all.flips_refused += r.flips_refused;
    all.topology_refused += r.topology_refused;
    all.visited += r.visited;
    all.triangles -= removed;
  }

  // --- joining the logs --------------------------------------------------------------------------

  // Joins the logs of the parts: collapses are sorted by the largest error so far in their part, so
  // that all parts are equally coarse at each point of the joined log.
  void join(std::vector<Part>& parts) {
    // Largest error so far, part, index of the collapse in the part.
    using Head = std::tuple<float, std::size_t, std::size_t>;
    std::priority_queue<Head, std::vector<Head>, std::greater<>> heads;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (!parts[p].log.error.empty()) heads.push({parts[p].log.error[0], p, 0});
    }
    reserve();
    // nodes[part][collapse]: index of the collapse's node in the joined log.
    std::vector<std::vector<std::uint32_t>> nodes(parts.size());
    while (!heads.empty()) {
      const auto [error, p, k] = heads.top();
      heads.pop();
      append(parts[p], k, nodes[p]);
      const std::vector<float>& errors = parts[p].log.error;
      if (k + 1 < errors.size()) heads.push({std::max(error, errors[k + 1]), p, k + 1});
    }
  }

  void reserve() {
    lod::CollapseLog& log = result_.log;
    log.children.reserve(vertices());
    log.positions.reserve(3 * std::size_t{vertices()});
    log.error.reserve(vertices());
    for (const mesh::Feature& f : mesh_.features)
      log.features.emplace_back().reserve(f.dimension * vertices());
  }

  // Appends collapse k of a part to the log. nodes: indices in the joined log of the part's earlier
  // collapses; the new one is appended.
  void append(const Part& part, std::size_t k, std::vector<std::uint32_t>& nodes) {
    lod::CollapseLog& log = result_.log;
    const auto own = static_cast<std::uint32_t>(part.vertices.size());
    const auto node = [&](std::uint32_t n) { return n < own ? part.vertices[n] : nodes[n - own]; };
    const auto [a, b] = part.log.children[k];
    nodes.push_back(vertices() + static_cast<std::uint32_t>(log.children.size()));
    log.children.push_back({node(a), node(b)});
    log.error.push_back(part.log.error[k]);
    appendRow(part.log.positions, k, 3, log.positions);
    for (std::size_t f = 0; f < log.features.size(); ++f)
      appendRow(part.log.features[f], k, mesh_.features[f].dimension, log.features[f]);
  }

  static void appendRow(const std::vector<float>& from, std::size_t row, std::size_t dimension,
                        std::vector<float>& to) {
    const auto first = from.begin() + static_cast<std::ptrdiff_t>(row * dimension);
    to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(dimension));
  }

  // --- the final reduction -----------------------------------------------------------------------

  void reduceRest() {
    const std::size_t first = result_.log.children.size();
    Part rest;  // its `vertices` are indices of nodes of the joined log
    Reduction r;
    {
      std::vector<bool> locked;
      const mesh::Mesh mesh = restOf(rest.vertices, locked);
      Progress progress;
      if (progress_) {
        progress = [&](const ReduceProgress& p) {
          return progress_({first + p.collapses, p.triangles});
        };
      }
      // The blocks kept seams fixed, since vertices at block borders were locked; here seams may
      // shrink.
      std::vector<std::uint32_t> coincident;
      if (!locked.empty() && plan_.seams_shrink)
        coincident = mesh::coincidentVertices(mesh.positions);
      r = runQuadric(mesh, plan_, locked, progress, std::move(coincident));
    }
    rest.log = std::move(r.log);
    std::vector<std::uint32_t> nodes;
    for (std::size_t k = 0; k < rest.log.children.size(); ++k) append(rest, k, nodes);
    addReport(r.report, 0);
    result_.report.triangles = r.report.triangles;
    result_.report.by_all_rules = r.report.by_all_rules;
    result_.report.stopped = r.report.stopped;
  }

  // Returns the mesh that remains after the reduction of the blocks. Output `nodes`: for each of
  // its vertices, the node of the joined log. Output `locked`: for each vertex, whether a locked
  // vertex of the input mesh has merged into it; stays empty if none is locked.
  mesh::Mesh restOf(std::vector<std::uint32_t>& nodes, std::vector<bool>& locked) const {
    const lod::CollapseLog& log = result_.log;
    const std::size_t n = vertices(), all = n + log.children.size();
    // into[node] is first the node that `node` merges into, later the index of the vertex of `rest`
    // that it has become.
    std::vector<std::uint32_t> into(all, kNoNode);
    for (std::size_t k = 0; k < log.children.size(); ++k) {
      for (const std::uint32_t child : log.children[k])
        into[child] = static_cast<std::uint32_t>(n + k);
    }
    nodes.resize(all - 2 * log.children.size());
    auto number = static_cast<std::uint32_t>(nodes.size());
    for (std::size_t node = all; node-- > 0;) {
      if (into[node] == kNoNode)
        nodes[into[node] = --number] = static_cast<std::uint32_t>(node);
      else
        into[node] = into[into[node]];
    }
    if (!locked_.empty()) {
      locked.resize(nodes.size());
      for (std::size_t v = 0; v < n; ++v) {
        if (locked_[v]) locked[into[v]] = true;
      }
    }
    mesh::Mesh rest;
    for (std::size_t i = 0; i < mesh_.triangles.size(); i += 3) {
      const std::uint32_t* t = &mesh_.triangles[i];
      const std::uint32_t c[] = {into[t[0]], into[t[1]], into[t[2]]};
      if (c[0] != c[1] && c[1] != c[2] && c[2] != c[0])
        rest.triangles.insert(rest.triangles.end(), c, c + 3);
    }
    rest.positions = rowsOf(nodes, mesh_.positions, log.positions, 3);
    for (std::size_t f = 0; f < mesh_.features.size(); ++f) {
      const mesh::Feature& feature = mesh_.features[f];
      rest.features.push_back({feature.name, feature.dimension,
                               rowsOf(nodes, feature.values, log.features[f], feature.dimension)});
    }
    return rest;
  }

  static std::vector<float> rowsOf(const std::vector<std::uint32_t>& nodes,
                                   const std::vector<float>& leaves,
                                   const std::vector<float>& inner, std::size_t dimension) {
    std::vector<float> rows(nodes.size() * dimension);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::size_t at = nodes[i] * dimension;
      std::copy_n(at < leaves.size() ? &leaves[at] : &inner[at - leaves.size()], dimension,
                  &rows[i * dimension]);
    }
    return rows;
  }

  const mesh::Mesh& mesh_;
  const QuadricPlan& plan_;
  const std::vector<bool>& locked_;
  std::size_t blocks_;
  const Progress& progress_;
  // Shares of the triangles (0..1): requested by the caller; left by the blocks.
  double target_, share_;
  Reduction result_;
  bool cancelled_ = false;
};

}  // namespace

Reduction reduceInBlocks(const mesh::Mesh& mesh, const QuadricPlan& plan,
                         const std::vector<bool>& locked, std::size_t blocks,
                         const Progress& progress) {
  return InBlocks(mesh, plan, locked, blocks, progress).run();
}

}  // namespace merlin::render::reduce
