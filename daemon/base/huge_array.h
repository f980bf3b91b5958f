// HugeArray: a large array of plain values on huge pages, initially zero.
//
// With random access, 4 KiB pages cost a page-table walk (a TLB miss) for each access; 2 MiB pages
// do not. Pages that were never touched use no memory. Small arrays stay on small pages.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#include <sys/mman.h>

namespace merlin {

template <typename T>
class HugeArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  static constexpr std::size_t kPage = std::size_t{2} << 20;
  static constexpr std::size_t kWorthIt = std::size_t{8} << 20;

 public:
  HugeArray() = default;
  // Makes an array of `size` zeros. Throws std::bad_alloc.
  explicit HugeArray(std::size_t size) : size_(size), bytes_(roundUp(size * sizeof(T)) + kPage) {
    if (size > (SIZE_MAX - 2 * kPage) / sizeof(T)) throw std::bad_alloc();
    base_ = ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE,
                   MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (base_ == MAP_FAILED) throw std::bad_alloc();
    void* at = base_;
    std::size_t room = bytes_;
    data_ = static_cast<T*>(std::align(kPage, size * sizeof(T), at, room));
    if (size * sizeof(T) >= kWorthIt)
      ::madvise(data_, roundUp(size * sizeof(T)), MADV_HUGEPAGE);  // a hint
  }
  HugeArray(HugeArray&& other) noexcept { *this = std::move(other); }
  HugeArray& operator=(HugeArray&& other) noexcept {
    std::swap(base_, other.base_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  HugeArray(const HugeArray&) = delete;
  HugeArray& operator=(const HugeArray&) = delete;
  ~HugeArray() {
    if (base_) ::munmap(base_, bytes_);
  }

  T* data() const noexcept { return data_; }
  std::size_t size() const noexcept { return size_; }
  T& operator[](std::size_t i) const noexcept { return data_[i]; }

 private:
  static std::size_t roundUp(std::size_t bytes) { return (bytes + kPage - 1) / kPage * kPage; }

  void* base_ = nullptr;
  T* data_ = nullptr;
  std::size_t size_ = 0, bytes_ = 0;
};

}  // namespace merlin
