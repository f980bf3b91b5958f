// SharedMemory: one POSIX shared-memory object, owned by its writer or mapped by a reader.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin {

class SharedMemory {
 public:
  // A new object of `size` zero bytes under `name` ("/merlin-wall"), locked for as long as this
  // lives; what a dead owner left under the name is replaced. Its pages are there from the start,
  // so that no later write can fault for want of memory.
  // Errors: kBusy (a living process owns it), kIo.
  static Result<SharedMemory> create(const std::string& name, std::size_t size);

  // What another process made, read-only. Errors: kNotFound, kIo, kMalformed (empty).
  static Result<SharedMemory> open(const std::string& name);

  // True where a living process holds the object of that name.
  static bool owned(const std::string& name);

  SharedMemory() = default;
  SharedMemory(SharedMemory&& other) noexcept;
  SharedMemory& operator=(SharedMemory&& other) noexcept;
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  ~SharedMemory();  // unmaps; the owner also removes the name

  std::byte* data() const noexcept { return data_; }
  std::size_t size() const noexcept { return size_; }

 private:
  SharedMemory(UniqueFd fd, std::byte* data, std::size_t size, std::string owned_name)
      : fd_(std::move(fd)), data_(data), size_(size), owned_name_(std::move(owned_name)) {}

  UniqueFd fd_;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  std::string owned_name_;  // empty for a reader
};

}  // namespace merlin
