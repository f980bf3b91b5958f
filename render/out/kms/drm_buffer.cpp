#include "render/out/kms/drm_buffer.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <drm_fourcc.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include "render/out/kms/drm_objects.h"

namespace merlin::render::out::kms {
namespace {

class DumbBuffer final : public Buffer {
 public:
  explicit DumbBuffer(DrmFile file) : file_(std::move(file)) {}
  ~DumbBuffer() override {
    if (!bytes_.empty()) ::munmap(bytes_.data(), bytes_.size());
    if (id_ != 0 && !file_->stays_shown) drmModeRmFB(file_->get(), id_);
  }
  DumbBuffer(const DumbBuffer&) = delete;
  DumbBuffer& operator=(const DumbBuffer&) = delete;

  Id id() const override { return id_; }
  std::span<std::uint8_t> bytes() override { return bytes_; }
  std::size_t pitch() const override { return pitch_; }
  std::shared_ptr<const DmaBuf> shared() const override { return shared_; }
  std::string unsharedReason() const override {
    return fmt::format("{}: {}", Buffer::unsharedReason(), errnoText(unshared_errno_));
  }

  // Returns false, with errno set, if the card has no memory for the buffer.
  bool create(std::uint32_t width, std::uint32_t height) {
    const int fd = file_->get();
    std::uint64_t size = 0;
    std::uint32_t handle = 0;
    if (drmModeCreateDumbBuffer(fd, width, height, 32, 0, &handle, &pitch_, &size) != 0)
      return false;
    const std::uint32_t handles[4] = {handle}, pitches[4] = {pitch_}, offsets[4] = {};
    const bool made = drmModeAddFB2(fd, width, height, DRM_FORMAT_XRGB8888, handles, pitches,
                                    offsets, &id_, 0) == 0 &&
                      map(handle, static_cast<std::size_t>(size));
    if (made) share(handle, width, height);
    // The handle is no longer needed, since the frame buffer and the mapping keep the memory. If
    // this process is killed, the next one can list and remove its frame buffers, but not a handle.
    const int error = errno;
    drmModeDestroyDumbBuffer(fd, handle);
    errno = error;
    return made;
  }

 private:
  bool map(std::uint32_t handle, std::size_t size) {
    std::uint64_t offset = 0;
    if (drmModeMapDumbBuffer(file_->get(), handle, &offset) != 0) return false;
    void* const at = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file_->get(),
                            static_cast<off_t>(offset));
    if (at == MAP_FAILED) return false;
    bytes_ = {static_cast<std::uint8_t*>(at), size};
    std::memset(at, 0, size);
    return true;
  }

  // Exports the buffer's memory for a GPU. The kernel promises no acceleration for "dumb" memory;
  // the GPU's driver decides at the import whether it draws there.
  void share(std::uint32_t handle, std::uint32_t width, std::uint32_t height) {
    int fd = -1;
    struct stat node {};
    if (drmPrimeHandleToFD(file_->get(), handle, DRM_CLOEXEC | DRM_RDWR, &fd) != 0) {
      unshared_errno_ = errno;
      return;
    }
    auto shared = std::make_shared<DmaBuf>();
    shared->file = UniqueFd(fd);
    shared->width = static_cast<int>(width);
    shared->height = static_cast<int>(height);
    shared->format = DRM_FORMAT_XRGB8888;
    shared->modifier = DRM_FORMAT_MOD_LINEAR;
    shared->pitch = pitch_;
    if (::fstat(file_->get(), &node) == 0) shared->device = deviceFolder(node.st_rdev);
    shared_ = std::move(shared);
  }

  DrmFile file_;
  std::uint32_t pitch_ = 0;
  Id id_ = 0;
  std::span<std::uint8_t> bytes_;
  std::shared_ptr<const DmaBuf> shared_;
  int unshared_errno_ = 0;
};

}  // namespace

Result<std::shared_ptr<Buffer>> makeDumbBuffer(const DrmFile& file, int width, int height) {
  auto buffer = std::make_shared<DumbBuffer>(file);
  if (!buffer->create(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)))
    return Error{Errc::kIo, fmt::format("no memory for a picture of {}x{} pixels: {}", width,
                                        height, errnoText(errno))};
  return std::shared_ptr<Buffer>(std::move(buffer));
}

}  // namespace merlin::render::out::kms
