// Replaces the global operator new with one that counts the bytes in use. Include it in exactly one
// source file of a program that does not include count_allocations.h. Sanitizers replace operator
// new or pad what is allocated, so nothing is counted in their builds. A HugeArray is not counted,
// since it does not allocate with operator new.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

#include <malloc.h>

#include "daemon/base/sanitizer.h"

namespace merlin::test {
inline std::atomic<std::size_t> bytes_used{0}, most_bytes_used{0};

// Returns the largest number of bytes that were in use at once while `work` ran, beyond those in
// use before; 0 in a sanitizer's build. Allocations of all threads are counted, so no other thread
// may allocate meanwhile.
template <typename Work>
std::size_t peakBytesOf(const Work& work) {
  const std::size_t before = bytes_used;
  most_bytes_used = before;
  work();
  return most_bytes_used - before;
}
}  // namespace merlin::test

#if !defined(MERLIN_ANY_SANITIZER)
// Not inlined: g++ 12 warns of a mismatched new and delete where it inlines only one of the two.
[[gnu::noinline]] void* operator new(std::size_t size) {
  void* const p = std::malloc(size == 0 ? 1 : size);
  if (!p) throw std::bad_alloc();
  using namespace merlin::test;
  const std::size_t now = bytes_used += ::malloc_usable_size(p);
  if (now > most_bytes_used) most_bytes_used = now;
  return p;
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
  if (p) merlin::test::bytes_used -= ::malloc_usable_size(p);
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { ::operator delete(p); }
#endif
