// Replaces the global operator new with one that counts its calls and keeps the largest size
// requested. Include it in exactly one source file of a program. The thread sanitizer has operators
// of its own, so nothing is counted there.
#pragma once

#include <atomic>
#include <cstdlib>
#include <new>

#include "daemon/base/sanitizer.h"

namespace merlin::test {
inline std::atomic<long> allocations{0};
inline std::atomic<std::size_t> largest_allocation{0};
}  // namespace merlin::test

#if !defined(MERLIN_THREAD_SANITIZER)
// Not inlined: g++ 12 warns of a mismatched new and delete where it inlines only one of the two.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++merlin::test::allocations;
  if (size > merlin::test::largest_allocation) merlin::test::largest_allocation = size;
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++merlin::test::allocations;  // std::stable_sort calls this overload
  if (size > merlin::test::largest_allocation) merlin::test::largest_allocation = size;
  return std::malloc(size == 0 ? 1 : size);
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
#endif
