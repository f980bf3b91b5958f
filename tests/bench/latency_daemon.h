// The part of ./dev bench latency that uses a real merlind: the CPU time of its devices, and the
// terms of a whole wall's latency.
#pragma once

#include "tests/bench/demo_daemon.h"
#include "tests/bench/figures.h"

namespace merlin::bench {

// Measures the CPU time of all three devices at their highest rates. Takes 13 s.
void benchCpu(const DemoOptions& options, const test::TempDir& dir, Report& report);

// Measures the terms of L = wire + parse and publish + age at pick-up + wait for the frame + draw
// and present. Takes 10 s.
void benchEquation(const DemoOptions& options, const test::TempDir& dir, Report& report);

}  // namespace merlin::bench
