// QuadricReducer: collapses edges by the costs of quadric_evaluate, on several threads. Private to
// render/reduce.
//
// The vertices are divided into parts along a space-filling curve. At first each part is reduced by
// itself, step by step up to a common cost; no collapse reaches across its borders. Then parts are
// joined in pairs, so that borders never make up much of the mesh; when a sixth of the triangles is
// left, the mesh is reduced as a whole. The parts depend on the mesh alone, so the result does not
// depend on the number of threads.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "daemon/base/blocks.h"
#include "render/reduce/quadric/bucket_queue.h"
#include "render/reduce/quadric/quadric_evaluate.h"
#include "render/reduce/quadric/quadric_rules.h"
#include "render/reduce/quadric/quadric_witness.h"
#include "render/reduce/reduce.h"

namespace merlin::render::reduce {

class QuadricReducer {
 public:
  using Progress = std::function<bool(const ReduceProgress&)>;

  // `channels`: number of feature values per vertex that contribute to the cost. The mesh must
  // outlive the reducer.
  QuadricReducer(const mesh::Mesh& mesh, std::size_t channels, Threads threads);

  // Sets a channel: values[v * stride] is its value at vertex v of the mesh. A difference of 1
  // costs like a distance of `scale` model units.
  void setChannel(std::size_t channel, const float* values, std::size_t stride, float scale);

  // values: one label per vertex of the mesh. Vertices with different labels merge only when no
  // other collapse is allowed.
  void setLabels(const float* values);

  // Keeps each vertex v of the mesh with locked[v] where it is as long as any other collapse is
  // allowed.
  void lock(const std::vector<bool>& locked);

  // Lets seams shrink; to be called after lock() has locked their vertices. next: rings of
  // coincident vertices of the mesh (samePlace()). Where a ring has two vertices, an edge along the
  // seam may collapse together with the coincident edge on the other side.
  void pair(const std::vector<std::uint32_t>& next);

  struct Limits {
    std::size_t triangles = 0;  // stop when no more than these are left; 0: no limit
    float error = std::numeric_limits<float>::infinity();  // maximum of a collapse, model units
    bool preserve_topology = false, preserve_components = false;
    bool by_all_rules = false;  // stop when the rules allow no more, instead of dropping one
    bool fast = false;          // accept costs that have risen up to 4 times; no witnesses
    Threads threads = 1;
  };
  // Returns why it stopped: a value of ReduceReport::stopped.
  const char* run(const Limits& limits, const Progress& progress);

  // Writes a channel's value at the node of collapse k to values[k * stride], in the unit in which
  // setChannel() was given them. `scale`: as in setChannel().
  void channelValues(std::size_t channel, float scale, float* values, std::size_t stride) const;

  // Returns the log; of its features only "normal" is filled.
  Reduction finish(const mesh::Mesh& mesh);

 private:
  // A unit of work for one thread: a part of the mesh, or the whole mesh.
  struct Worker {
    BucketQueue queue;
    StarRoom room;
    EdgeCosts costs;
    EdgeCosts twin;                // of the coincident vertex across a seam
    EdgeCosts hub;                 // scratch
    std::vector<Corner> merged;    // scratch
    std::uint32_t* log = nullptr;  // dead vertices, in order
    std::size_t collapses = 0;
    std::size_t removed = 0;  // triangles
    std::size_t flips = 0, links = 0;
    std::size_t visited = 0;             // triangles in the stars looked at
    bool too_coarse = false;             // an edge was refused because of the error limit
    std::uint32_t refused_star = ~0U;    // triangles of the smallest star refused for its size
    std::vector<std::uint32_t> revived;  // hubs that now have few triangles
    bool inside_only = false;            // for a part: only vertices whose ring is inside it
    // For a part: the range of its vertices on the curve, its number of triangles (about), and the
    // number of collapses at the end of each step.
    std::uint32_t begin = 0, end = 0;
    std::size_t triangles = 0;
    std::vector<std::size_t> steps;

    void takeOver(Worker&& other);
  };
  struct Range {
    float low, high;
  };

  auto nextOf() const {
    return [this](std::uint32_t v) -> std::uint32_t& { return next_[v]; };
  }
  QuadricView view() const { return {&mesh_[0], mesh_.corners(0), &channels_}; }
  void evaluate(Worker& w, std::uint32_t v) { evaluate_(view(), v, w.costs); }
  // An edge is collapsed if its cost is below the upper end of its bucket times this factor.
  float tolerance() const { return fast_ ? 4.0F : 1.25F; }
  void enqueue(Worker& w, std::uint32_t v, float cost);
  void prefetch(Worker& w) const;
  void reduceTo(Worker& w, std::size_t removed, std::size_t bucket_limit);
  void tryVertex(Worker& w, std::uint32_t v);
  void leaveOut(std::uint32_t v, EdgeCosts& costs) const;
  bool mayCollapse(Worker& w, const EdgeCosts& costs, std::uint32_t v, std::uint32_t edge);
  bool guard(Worker& w, std::uint32_t v, std::uint32_t edge);
  float witnessDeviation(Worker& w, std::uint32_t v, std::uint32_t edge) const;
  float errorOf(const EdgeCosts& costs, std::uint32_t v, std::uint32_t edge) const;
  void collapse(Worker& w, std::uint32_t v, std::uint32_t edge);
  void addNormalOf(std::uint32_t twin, float* normal) const;
  void shareNormal(std::uint32_t from, std::uint32_t to);
  bool isAlongSeam(const EdgeCosts& costs, std::uint32_t v, std::uint32_t edge) const;
  std::uint32_t findTwin(Worker& w, std::uint32_t v, std::uint32_t edge);
  void stayOnSeam(Worker& w, std::uint32_t v, std::uint32_t edge);
  bool collapseSeam(Worker& w, std::uint32_t v, std::uint32_t edge);
  void mixChannels(std::uint32_t v, std::uint32_t x, const EdgeCosts& costs, std::uint32_t edge);
  void mergeStars(Worker& w, std::uint32_t v, std::uint32_t x);
  void renameInRing(Worker& w, std::uint32_t o, std::uint32_t v, std::uint32_t x, bool beside);
  void wakeRing(Worker& w, std::uint32_t v, float cost);
  void loseTriangle(Worker& w, std::uint32_t o);
  void reviveHubs(Worker& w, float cost);

  void forEachLiving(const std::function<void(std::uint32_t, EdgeCosts&)>& work) const;
  void releaseHubs();
  void setQuadrics();
  std::vector<Worker> makeParts(std::size_t count);
  bool isInside(const Worker& w, std::uint32_t v) const;
  void startPart(Worker& w, EvaluateEdges measure);
  void reduceParts(std::size_t keep, const Progress& progress);
  void reduceInSteps(std::vector<Worker>& parts, std::size_t keep, std::size_t& limit,
                     const Progress& progress);
  void joinLogs(std::vector<Worker>& parts, HugeArray<std::uint32_t>& joined);
  void joinPart(Worker& w, Worker&& other);
  void requeue();
  void reduceWhole(std::size_t keep, const Progress& progress);
  std::uint32_t smallestLeftOut() const;
  void reduceStage(std::size_t keep, const Progress& progress);

  NodeRecord recordOf(std::uint32_t dead) const;
  void copyTo(lod::CollapseLog& log, std::vector<float>* normals, std::size_t k) const;
  void pin(lod::CollapseLog& log);
  static constexpr std::uint32_t kNowhere = ~std::uint32_t{0};
  // Maximum number of triangles in a star while the topology is kept. Useful surfaces stay below
  // it; a collapse next to a larger star would take too long.
  static constexpr std::uint32_t kMostCorners = 128;
  // The same once the topology may change and stars are unordered: kMostUnordered at first. Of a
  // star above kManyCorners only a few edges are tried.
  static constexpr std::uint32_t kManyCorners = 16, kMostUnordered = 32;

  QuadricMesh mesh_;
  const float* input_positions_;  // of the mesh, which outlives the reducer
  QuadricChannels channels_;
  std::vector<float> labels_;  // by vertex; empty if there are none
  // By node: the locked vertex at whose position it is, or kNowhere; empty if none is locked.
  std::vector<std::uint32_t> pinned_;
  // By vertex: the coincident vertex across a seam, or kNowhere; empty if seams do not shrink.
  std::vector<std::uint32_t> twins_;
  bool keep_components_ = false, fast_ = false;
  // Ranges of the channels' values, before and after weighting; values at new vertices stay in
  // them.
  std::vector<Range> given_, ranges_;
  EvaluateEdges evaluate_;
  JudgeEdge judge_;
  FindFarther farther_;
  HugeArray<std::uint32_t> log_;
  HugeArray<std::uint32_t> next_;  // links of the queue's lists; not in the records, to stay cached
  Worker whole_;
  std::size_t triangles_;         // left
  std::size_t by_all_rules_ = 0;  // left when the first rule was dropped
  float max_error_ = std::numeric_limits<float>::infinity();  // unit: mean edge length
  QuadricStage stage_ = QuadricStage::kAll;
  std::uint32_t most_corners_ = kMostCorners;  // of the stars that take part
  bool hubs_ = false;                          // some vertex is a hub
  Threads threads_ = 1;
  bool cancelled_ = false;
};

}  // namespace merlin::render::reduce
