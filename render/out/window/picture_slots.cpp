#include "render/out/window/picture_slots.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>

namespace merlin::render::out {
namespace {

std::size_t bytesOf(int width, int height) {
  return std::size_t{4} * PictureSlots::kCount * static_cast<std::size_t>(width) *
         static_cast<std::size_t>(height);
}

Error systemError(const char* what, int number) {
  return {Errc::kIo,
          fmt::format("memory for the window's pictures: {}: {}", what, std::strerror(number))};
}

}  // namespace

Result<PictureSlots> PictureSlots::map(UniqueFd memory, int protection, int width, int height) {
  void* const at = ::mmap(nullptr, bytesOf(width, height), protection, MAP_SHARED, memory.get(), 0);
  if (at == MAP_FAILED) return systemError("mmap", errno);
  return PictureSlots(std::move(memory), static_cast<std::uint8_t*>(at), width, height);
}

Result<PictureSlots> PictureSlots::make(int width, int height) {
  UniqueFd memory(::memfd_create("merlin-window", MFD_CLOEXEC));
  if (!memory.valid()) return systemError("memfd_create", errno);
  const int refused =
      ::posix_fallocate(memory.get(), 0, static_cast<off_t>(bytesOf(width, height)));
  if (refused != 0) return systemError("posix_fallocate", refused);
  return map(std::move(memory), PROT_READ | PROT_WRITE, width, height);
}

Result<PictureSlots> PictureSlots::open(UniqueFd memory, int width, int height) {
  struct stat there {};
  if (::fstat(memory.get(), &there) != 0) return systemError("fstat", errno);
  if (width <= 0 || height <= 0 || static_cast<std::size_t>(there.st_size) < bytesOf(width, height))
    return Error{Errc::kMalformed, "memory for the window's pictures: has another size"};
  return map(std::move(memory), PROT_READ, width, height);
}

PictureSlots::PictureSlots(PictureSlots&& other) noexcept
    : memory_(std::move(other.memory_)),
      pixels_(std::exchange(other.pixels_, nullptr)),
      width_(other.width_),
      height_(other.height_) {}

PictureSlots::~PictureSlots() {
  if (pixels_) ::munmap(pixels_, bytesOf(width_, height_));
}

}  // namespace merlin::render::out
