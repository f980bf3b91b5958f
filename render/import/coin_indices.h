// Whether a shape of Coin's graph names only values that there are. Coin itself does not ask: it
// takes what lies in memory behind the last one.
#pragma once

#include "daemon/base/result.h"

class SoCallbackAction;
class SoShape;

namespace merlin::render::import {

// shape    about to be drawn by the action: coordinates, colours and texture coordinates that it
//          does not have itself are those of the action's state. Normals are not looked at.
// errors   kMalformed: an index or a number of corners beyond what there is, or too few indices;
//          says which, and how many there are.
// cost     O(n) of the shape's indices
Result<Ok> checkIndices(const SoCallbackAction& action, const SoShape& shape);

}  // namespace merlin::render::import
