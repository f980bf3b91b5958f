// The fuzz targets: one function for each reader of bytes that come from outside. libFuzzer calls
// one target (fuzz_main.cpp, ./dev fuzz); fuzz_corpus_test calls all targets with the files in
// corpus/.
#pragma once

#include <cstdint>
#include <span>

namespace merlin::fuzz {

using Bytes = std::span<const std::uint8_t>;

struct Target {
  const char* name;  // also the name of the target's folder in corpus/
  void (*run)(Bytes bytes);
};

std::span<const Target> targets();

}  // namespace merlin::fuzz
