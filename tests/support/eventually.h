// eventually(): polls a condition until it is true or the deadline has passed, so that a test with
// real processes and threads does not depend on the machine's speed.
#pragma once

#include <chrono>
#include <thread>

namespace merlin::test {

template <typename Condition>
bool eventually(Condition condition, std::chrono::seconds deadline = std::chrono::seconds(120)) {
  const auto end = std::chrono::steady_clock::now() + deadline;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace merlin::test
