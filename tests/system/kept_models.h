// Models of the demo's scan, made once for all tests of a build and kept beside its programs. Most
// tests with the real programs need one, and under a sanitizer each takes seconds to make.
#pragma once

#include <functional>
#include <string>

#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace merlin::test {

// Returns the path of the kept file `name`, which ends in .mrm. If the file does not exist, or is
// older than the program merlin, `make` makes it first, under a temporary name, since tests run in
// parallel.
std::string keptModel(const std::string& name,
                      const std::function<Outcome(const std::string& path)>& make);

// Copies the demo's scan with all resolutions to FOLDER/full.mrm in the test's folder; returns that
// path.
std::string makeFullModel(const TempDir& dir);

// Makes FOLDER/model.mrm with `percent` per cent of the triangles of the demo's scan, few enough
// for a build with a sanitizer to draw. Returns its path.
std::string makeModel(const TempDir& dir, int percent = 20);

}  // namespace merlin::test
