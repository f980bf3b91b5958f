// One round of ./dev bench latency: one reader on one line, and one client of the shared memory
// into which the reader publishes.
#pragma once

#include <functional>
#include <vector>

#include <sys/types.h>

#include "tests/bench/latency_kind.h"

namespace merlin::bench {

enum Reader { kMerlin, kAwake, kSleeping, kSpinning, kBare, kReaders };
inline constexpr const char* kReaderNames[] = {"MERLIN", "MERLIN, awake", "sleeps 1 ms", "spins",
                                               "bare blocking"};
enum Line { kSocketPair, kPty };
inline constexpr const char* kLineNames[] = {"socket pair", "pty"};

struct RoundSize {
  int samples = 1000;  // at most 60,000
  double rate_hz = 250;
};

// Memory shared by the processes of a round; reused for all rounds.
struct Times;
Times& makeTimes();

struct Round {
  std::vector<double> latency_us;  // latency of each record, whether the client saw or missed it
  double cpu_share = 0;            // CPU time of the reader's thread / wall time
  bool real_time = false;          // whether the reader's thread got real-time priority
};

// Runs one round. Errors: throws DidNotRun if the line, the segment, the client or the reader does
// not run to the end. REQUIRES: the reader kAwake only if io::limitCpuLatency(0) succeeds.
Round runRound(const RoundSize& size, Reader reader, Line line, Times& times,
               const Kind& kind = kGloveKind);

// Starts a process that runs `body` and dies with this one.
pid_t child(const std::function<void()>& body);

}  // namespace merlin::bench
