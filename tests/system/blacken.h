// Overwrites a wall's frame in shared memory, as any program of the same user may do.
#pragma once

#include <cstring>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>

#include "daemon/base/unique_fd.h"
#include "render/out/shared_frame_layout.h"

namespace merlin::test {

// Overwrites the newest frame of this instance in shared memory with zeros.
inline void blacken(const std::string& instance) {
  namespace framebuffer = render::out::framebuffer;
  const std::string path = "/dev/shm/" + instance + "-framebuffer";
  const auto size = static_cast<std::size_t>(std::filesystem::file_size(path));
  const UniqueFd file(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  void* const at = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file.get(), 0);
  ASSERT_NE(at, MAP_FAILED);
  const auto& header = *static_cast<const framebuffer::Header*>(at);
  const std::size_t newest = header.newest.load() % framebuffer::kBuffers;
  std::memset(static_cast<std::byte*>(at) + header.buffers[newest].offset, 0,
              std::size_t{header.stride} * header.height);
  ::munmap(at, size);
}

}  // namespace merlin::test
