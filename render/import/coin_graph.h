// Whether a walk of Coin's graph ends.
#pragma once

#include "daemon/base/result.h"

class SoNode;

namespace merlin::render::import {

// errors   kMalformed: a node is below itself, or shared nodes multiply beyond 10^7 shapes.
// cost     O(n) of the nodes, each counted once
Result<Ok> checkGraphEnds(SoNode* root);

}  // namespace merlin::render::import
