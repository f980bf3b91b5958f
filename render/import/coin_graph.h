// Checks that a traversal of Coin's scene graph ends.
#pragma once

#include "daemon/base/result.h"

class SoNode;

namespace merlin::render::import {

// errors   kMalformed: a node is its own descendant, or shared nodes multiply to over 10^7 shapes.
// cost     O(n) for n nodes; a shared node is visited once
Result<Ok> checkGraphEnds(SoNode* root);

}  // namespace merlin::render::import
