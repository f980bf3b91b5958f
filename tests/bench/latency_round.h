// One round of ./dev bench latency: one reader of one line, and a client of its shared memory.
#pragma once

#include <functional>
#include <vector>

#include <sys/types.h>

namespace merlin::bench {

enum Reader { kMerlin, kAwake, kSleeping, kSpinning, kBare, kReaders };
inline constexpr const char* kReaderNames[] = {"MERLIN", "MERLIN, awake", "sleeps 1 ms", "spins",
                                               "bare blocking"};
enum Line { kSocketPair, kPty };
inline constexpr const char* kLineNames[] = {"socket pair", "pty"};

struct RoundSize {
  int samples = 1000;  // 60,000 at most
  double rate_hz = 250;
};

// Memory that the processes of a round share; one for all rounds.
struct Times;
Times& makeTimes();

struct Round {
  std::vector<double> latency_us;  // of each record that the client has seen or slept over
  double cpu_share = 0;            // of the reader's thread
  bool real_time = false;          // whether that thread was allowed to be
};

// Throws DidNotRun where line, segment, client or reader does not run to the end. kAwake only where
// io::limitCpuLatency(0) is allowed.
Round runRound(const RoundSize& size, Reader kind, Line line, Times& times);

// A process that does `body` and dies with this one.
pid_t child(const std::function<void()>& body);

}  // namespace merlin::bench
