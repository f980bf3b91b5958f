// The part of ./dev bench latency that a real merlind runs in: what its devices cost, and the terms
// of the latency of a whole wall.
#pragma once

#include "tests/bench/demo_daemon.h"
#include "tests/bench/figures.h"

namespace merlin::bench {

// All three devices at the highest rate that they have. Takes 13 s.
void benchCpu(const DemoOptions& options, const test::TempDir& dir, Report& report);

// L = wire + parse and publish + age at pick-up + wait for the frame + draw and present. Takes 10
// s.
void benchEquation(const DemoOptions& options, const test::TempDir& dir, Report& report);

}  // namespace merlin::bench
