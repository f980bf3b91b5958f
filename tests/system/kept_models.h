// Models of the demo's scan, made once for all tests of a build and kept beside its programs:
// under a sanitizer each takes seconds, and most tests with the real programs need one.
#pragma once

#include <functional>
#include <string>

#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace merlin::test {

// The kept file of this name, which ends in .mrm. If it is not there, or older than the program
// merlin, `make` writes it, under another name first: tests run side by side.
std::string keptModel(const std::string& name,
                      const std::function<Outcome(const std::string& path)>& make);

// The demo's scan at all resolutions, as a copy of the test's own: FOLDER/full.mrm.
std::string makeFullModel(const TempDir& dir);

// Makes FOLDER/model.mrm with `percent` of the triangles, so few that a build with a sanitizer can
// draw it. Returns its path.
std::string makeModel(const TempDir& dir, int percent = 20);

}  // namespace merlin::test
