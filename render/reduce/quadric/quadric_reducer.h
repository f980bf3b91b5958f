// QuadricReducer: collapses by the quadrics of quadric_evaluate, on several threads. Private to
// render/reduce.
//
// The vertices come in parts along the space-filling curve. First each part is reduced for itself,
// step by step up to the same cost, where no collapse reaches across its borders. Two by two they
// become one, so that borders are never much of what is left; with a sixth of the triangles left
// all is one. Parts follow from the mesh alone, so the result does not depend on the number of
// threads.
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

namespace merlin::render {

class QuadricReducer {
 public:
  using Progress = std::function<bool(const ReduceProgress&)>;

  // `channels`: how many values a vertex has that cost. The mesh must outlive this.
  QuadricReducer(const Mesh& mesh, std::size_t channels, Threads threads);

  // Values of a channel, of the mesh's vertices `stride` floats apart. `scale`: how many model
  // units a difference of 1 weighs.
  void setChannel(std::size_t channel, const float* values, std::size_t stride, float scale);

  // One a vertex of the mesh; vertices of different labels merge only when nothing else is left.
  void setLabels(const float* values);

  // Keeps these vertices of the mesh where they are until nothing else is left.
  void lock(const std::vector<bool>& locked);

  // Lets seams shrink; to be called after they were locked. next: rings of the mesh's vertices that
  // lie in one place (samePlace()); where a ring has two, edges along the seam may collapse, on
  // both sides at once.
  void pair(const std::vector<std::uint32_t>& next);

  struct Limits {
    std::size_t triangles = 0;                             // stop when no more are left; 0: none
    float error = std::numeric_limits<float>::infinity();  // no collapse is worse; model units
    bool preserve_topology = false, preserve_components = false;
    bool by_all_rules = false;  // stop where these allow no more, instead of dropping one
    bool fast = false;          // what has become dearer goes as well; no witnesses
    Threads threads = 1;
  };
  // Returns why it stopped, in reduce()'s words.
  const char* run(const Limits& limits, const Progress& progress);

  // Writes a channel's values at the nodes that collapses made, in their order, in the unit in
  // which they were given to setChannel(), `stride` floats apart.
  void channelValues(std::size_t channel, float scale, float* values, std::size_t stride) const;

  // The log; of the features of `mesh` only "normal" is filled.
  Reduction finish(const Mesh& mesh);

 private:
  // The work of one thread: a part of the mesh, or the whole.
  struct Worker {
    BucketQueue queue;
    StarRoom room;
    EdgeCosts costs;
    EdgeCosts twin;                // of a seam's other side
    EdgeCosts hub;                 // scratch
    std::vector<Corner> merged;    // scratch
    std::uint32_t* log = nullptr;  // dead vertices, in order
    std::size_t collapses = 0;
    std::size_t removed = 0;  // triangles
    std::size_t flips = 0, links = 0;
    std::size_t visited = 0;             // triangles of stars
    bool too_coarse = false;             // an edge's error was beyond the limit
    std::uint32_t refused_star = ~0U;    // the least that was refused for its size
    std::vector<std::uint32_t> revived;  // hubs that have few triangles by now
    bool inside_only = false;            // of a part: only vertices whose ring is in it
    // Of a part: the range of its vertices on the curve, its number of triangles (about), and the
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
  // A popped edge may cost so much more than its bucket and is still taken.
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
  void copyTo(CollapseLog& log, std::vector<float>* normals, std::size_t k) const;
  void pin(CollapseLog& log);
  static constexpr std::uint32_t kNowhere = ~std::uint32_t{0};
  // More than a surface of any use has; a step beside more would take too long.
  static constexpr std::uint32_t kMostCorners = 128;
  // Once topology may change, where stars have no order.
  static constexpr std::uint32_t kManyCorners = 16, kMostUnordered = 32;

  QuadricMesh mesh_;
  const float* input_positions_;  // the mesh's, which outlives this
  QuadricChannels channels_;
  std::vector<float> labels_;          // empty where there are none
  std::vector<std::uint32_t> pinned_;  // by node: the locked vertex that it stands on; if any are
  std::vector<std::uint32_t> twins_;   // of a seam's vertex the other one in its place; or empty
  bool keep_components_ = false, fast_ = false;
  // Ranges of the channels, as given and as weighted; no value leaves them.
  std::vector<Range> given_, ranges_;
  EvaluateEdges evaluate_;
  JudgeEdge judge_;
  FindFarther farther_;
  HugeArray<std::uint32_t> log_;
  HugeArray<std::uint32_t> next_;  // in a vertex' bucket; beside the records, so that it stays near
  Worker whole_;
  std::size_t triangles_;                                     // left
  std::size_t by_all_rules_ = 0;                              // left when the first rule gave way
  float max_error_ = std::numeric_limits<float>::infinity();  // in mean edges
  QuadricStage stage_ = QuadricStage::kAll;
  std::uint32_t most_corners_ = kMostCorners;  // of what takes part
  bool hubs_ = false;                          // there are some
  Threads threads_ = 1;
  bool cancelled_ = false;
};

}  // namespace merlin::render
