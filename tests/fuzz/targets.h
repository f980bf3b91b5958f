// What is fuzzed: everything that reads bytes from outside, a function for each. libFuzzer calls
// one of them (fuzz_main.cpp, ./dev fuzz); fuzz_corpus_test calls all with the files in corpus/.
#pragma once

#include <cstdint>
#include <span>

namespace merlin::fuzz {

using Bytes = std::span<const std::uint8_t>;

struct Target {
  const char* name;  // of its folder in corpus/, too
  void (*run)(Bytes bytes);
};

std::span<const Target> targets();

}  // namespace merlin::fuzz
