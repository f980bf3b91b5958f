// Counts what operator new is asked for, and keeps the largest. Replaces it: include it in one
// source of a program.
#pragma once

#include <atomic>
#include <cstdlib>
#include <new>

namespace merlin::test {
inline std::atomic<long> allocations{0};
inline std::atomic<std::size_t> largest_allocation{0};
}  // namespace merlin::test

// Not inlined: g++ 12 would find fault with a new and a delete of which it sees only one.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++merlin::test::allocations;
  if (size > merlin::test::largest_allocation) merlin::test::largest_allocation = size;
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++merlin::test::allocations;  // std::stable_sort asks so
  if (size > merlin::test::largest_allocation) merlin::test::largest_allocation = size;
  return std::malloc(size == 0 ? 1 : size);
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
