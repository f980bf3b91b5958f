// Large vectors on huge pages: huge_array.h says why. A page fault costs as much as writing the
// page, or, on a virtual machine, many times that; huge pages cause 512 times fewer faults.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <sys/mman.h>

namespace merlin {

// Calls v.resize(size), and asks the kernel for huge pages where the memory is large enough. Throws
// std::bad_alloc.
template <typename T>
void resizeHuge(std::vector<T>& v, std::size_t size) {
  constexpr std::uintptr_t kPage = std::uintptr_t{2} << 20;
  v.reserve(size);
  const auto at = reinterpret_cast<std::uintptr_t>(v.data());
  const std::uintptr_t begin = (at + kPage - 1) / kPage * kPage;
  const std::uintptr_t end = (at + size * sizeof(T)) / kPage * kPage;
  if (end > begin) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // a hint
  v.resize(size);
}

}  // namespace merlin
