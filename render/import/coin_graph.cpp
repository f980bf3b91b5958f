#include "render/import/coin_graph.h"

#include <unordered_map>
#include <utility>
#include <vector>

#include <Inventor/misc/SoChildList.h>
#include <Inventor/nodes/SoShape.h>
#include <fmt/format.h>

namespace merlin::render::import {
namespace {

constexpr double kMostShapes = 1e7;  // limit of shapes, each counted as often as it is used

// Traverses a graph whose nodes may have several parents, and finds structures that no traversal
// could finish: a node below itself, or shapes that are used too often.
class GraphCheck {
 public:
  Result<Ok> run(SoNode* root) {
    enter(root);
    while (!path_.empty()) {
      const auto [node, next] = path_.back();
      const SoChildList* const children = node->getChildren();
      if (!children || next >= children->getLength()) {
        leave();
        continue;
      }
      ++path_.back().second;
      SoNode* const child = (*children)[next];
      const auto known = shapes_.find(child);
      if (known == shapes_.end()) {
        enter(child);
      } else if (known->second < 0) {
        return Error{Errc::kMalformed, fmt::format("is cyclic: a {} contains itself",
                                                   child->getTypeId().getName().getString())};
      } else {
        sums_.back() += known->second;
      }
    }
    if (shapes_[root] <= kMostShapes) return Ok{};
    return Error{Errc::kMalformed,
                 fmt::format("uses its shapes {:.3g} times in all; at most {:.0f} uses are allowed",
                             shapes_[root], kMostShapes)};
  }

 private:
  void enter(SoNode* node) {
    shapes_[node] = -1;  // marks a node on the current path
    path_.emplace_back(node, 0);
    sums_.push_back(node->isOfType(SoShape::getClassTypeId()) ? 1 : 0);
  }
  void leave() {
    const double shapes = sums_.back();
    shapes_[path_.back().first] = shapes;
    path_.pop_back();
    sums_.pop_back();
    if (!sums_.empty()) sums_.back() += shapes;
  }

  std::vector<std::pair<SoNode*, int>> path_;
  std::vector<double> sums_;
  std::unordered_map<SoNode*, double> shapes_;  // number of shapes below a node; -1: not known yet
};

}  // namespace

Result<Ok> checkGraphEnds(SoNode* root) { return GraphCheck().run(root); }

}  // namespace merlin::render::import
