// Checks that a traversal of Coin's scene graph terminates.
#pragma once

#include "daemon/base/result.h"

class SoNode;

namespace merlin::render::import {

// Checks the graph below `root`. Errors: kMalformed, if a node is its own descendant, or if shared
// nodes multiply to more than 10^7 shapes. O(n) for n nodes, since a shared node is visited once.
Result<Ok> checkGraphEnds(SoNode* root);

}  // namespace merlin::render::import
