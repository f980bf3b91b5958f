// Checks that the indices of a shape in Coin's scene graph are in range. Coin itself does not check
// them and would read beyond the end of its arrays.
#pragma once

#include "daemon/base/result.h"

class SoCallbackAction;
class SoShape;

namespace merlin::render::import {

// Checks the indices of a shape.
//
// shape    is about to be drawn by the action. Coordinates, colours and texture coordinates that it
//          does not have itself are taken from the action's state. Normals are not checked.
// errors   kMalformed: an index or a number of corners is beyond the existing values, or there are
//          too few indices; the message says which, and how many exist.
// cost     O(n) for n indices of the shape
Result<Ok> checkIndices(const SoCallbackAction& action, const SoShape& shape);

}  // namespace merlin::render::import
