#include "render/out/kms/drm_scanout.h"

#include <cerrno>
#include <cstdint>
#include <iterator>
#include <utility>

#include <drm_fourcc.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include "render/out/kms/drm_objects.h"
#include "render/out/kms/drm_properties.h"
#include "render/out/kms/drm_users.h"

namespace merlin::render::out::kms {
namespace {

// The memory of one of the card's frame buffers, mapped according to the kernel's description.
class MappedBuffer {
 public:
  MappedBuffer(int fd, Id buffer) : fd_(fd), info_(drmModeGetFB2(fd, buffer), drmModeFreeFB2) {
    if (!info_) return;
    if (info_->handles[0] != 0) map();
    closeHandles();  // at once: they belong to the file, which may outlive this process
  }
  ~MappedBuffer() {
    if (at_) ::munmap(const_cast<std::uint8_t*>(at_), size_);
  }
  MappedBuffer(const MappedBuffer&) = delete;
  MappedBuffer& operator=(const MappedBuffer&) = delete;

  bool isMapped() const { return at_ != nullptr; }
  int width() const { return static_cast<int>(info_->width); }
  int height() const { return static_cast<int>(info_->height); }
  std::size_t pitch() const { return info_->pitches[0]; }
  std::span<const std::uint8_t> pixels() const {
    return std::span(at_, size_).subspan(info_->offsets[0]);
  }

 private:
  void map() {
    const bool readable =
        info_->pixel_format == DRM_FORMAT_XRGB8888 &&
        (info_->modifier == DRM_FORMAT_MOD_LINEAR || (info_->flags & DRM_MODE_FB_MODIFIERS) == 0);
    std::uint64_t offset = 0;
    if (!readable || drmModeMapDumbBuffer(fd_, info_->handles[0], &offset) != 0) return;
    size_ = info_->offsets[0] + std::size_t{info_->pitches[0]} * info_->height;
    void* const at = ::mmap(nullptr, size_, PROT_READ, MAP_SHARED, fd_, static_cast<off_t>(offset));
    if (at != MAP_FAILED) at_ = static_cast<const std::uint8_t*>(at);
  }
  // The kernel made these handles for this reading only; several planes may share one.
  void closeHandles() const {
    for (std::size_t i = 0; i < std::size(info_->handles); ++i) {
      const std::uint32_t handle = info_->handles[i];
      bool closed = handle == 0;
      for (std::size_t earlier = 0; earlier < i; ++earlier)
        closed = closed || info_->handles[earlier] == handle;
      if (!closed) drmCloseBufferHandle(fd_, handle);
    }
  }

  int fd_;
  Owned<drmModeFB2> info_;
  const std::uint8_t* at_ = nullptr;
  std::size_t size_ = 0;
};

class DrmScanout final : public Scanout {
 public:
  DrmScanout(DrmFile file, std::string path) : file_(std::move(file)), path_(std::move(path)) {}

  Result<ScannedOut> look(Id crtc, Id plane) override {
    const Owned<drmModePlaneRes> planes(drmModeGetPlaneResources(fd()), drmModeFreePlaneResources);
    if (!planes) return gone();
    ScannedOut out;
    for (std::uint32_t i = 0; i < planes->count_planes; ++i) {
      const Owned<drmModePlane> at(drmModeGetPlane(fd(), planes->planes[i]), drmModeFreePlane);
      if (!at || at->crtc_id != crtc || at->fb_id == 0) continue;
      if (planes->planes[i] == plane)
        out.buffer = at->fb_id;
      else
        out.covered = true;
    }
    const auto active = properties_.valueOf(fd(), crtc, DRM_MODE_OBJECT_CRTC, "ACTIVE");
    out.is_on = active.value_or(1) != 0 && (out.buffer != 0 || out.covered);
    return out;
  }

  Result<PictureDigest> read(Id buffer, int picture_width, int picture_height) override {
    const MappedBuffer mapped(fd(), buffer);
    if (!mapped.isMapped() || mapped.width() < picture_width || mapped.height() < picture_height)
      return Error{Errc::kIo, fmt::format("the picture on {} cannot be read back", path_)};
    const auto left = static_cast<std::size_t>((mapped.width() - picture_width) / 2);
    const auto top = static_cast<std::size_t>((mapped.height() - picture_height) / 2);
    const auto pixels = mapped.pixels().subspan(top * mapped.pitch() + 4 * left);
    return digestOf({picture_width, picture_height, pixels, mapped.pitch(), PixelOrder::kBgrx});
  }

  std::vector<std::string> others() const override { return programsWith(path_); }

 private:
  int fd() const { return file_->get(); }
  Error gone() const {
    return {Errc::kIo, fmt::format("{} is not there any more: {}", path_, errnoText(errno))};
  }

  DrmFile file_;
  std::string path_;
  DrmProperties properties_;
};

}  // namespace

std::shared_ptr<Scanout> makeDrmScanout(DrmFile file, std::string path) {
  return std::make_shared<DrmScanout>(std::move(file), std::move(path));
}

}  // namespace merlin::render::out::kms
