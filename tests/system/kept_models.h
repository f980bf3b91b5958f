// Models of the demo's scan, made once for all tests of a build and kept beside its programs. Most
// tests with the real programs need one, and under a sanitizer each takes seconds to make.
#pragma once

#include <functional>
#include <string>

#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace merlin::test {

// The path of the kept file `name`, which ends in .mrm. If the file does not exist, or is older
// than the program merlin, `make` writes it under a temporary name first, since tests run in
// parallel.
std::string keptModel(const std::string& name,
                      const std::function<Outcome(const std::string& path)>& make);

// Copies the demo's scan at all resolutions into the test's folder; returns the path
// FOLDER/full.mrm.
std::string makeFullModel(const TempDir& dir);

// Makes FOLDER/model.mrm with `percent` of the triangles, so few that a build with a sanitizer can
// draw it. Returns its path.
std::string makeModel(const TempDir& dir, int percent = 20);

}  // namespace merlin::test
