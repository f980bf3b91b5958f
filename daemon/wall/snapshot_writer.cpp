#include "daemon/wall/snapshot_writer.h"

#include <ctime>
#include <filesystem>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "daemon/base/log.h"
#include "render/out/png.h"
#include "render/out/shm_sink.h"

namespace merlin::wall {

SnapshotWriter::SnapshotWriter(std::string framebuffer, std::string folder)
    : framebuffer_(std::move(framebuffer)),
      folder_(std::move(folder)),
      thread_([this](const std::stop_token& stop) { loop(stop); }) {}

SnapshotWriter::~SnapshotWriter() {
  thread_.request_stop();
  thread_.join();
}

void SnapshotWriter::take() {
  const std::lock_guard lock(mutex_);
  asked_ = true;
  wake_.notify_one();
}

Result<std::string> SnapshotWriter::write() const {
  const auto frame = render::captureFrame(framebuffer_);
  if (!frame) return frame.error();
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) return Error{Errc::kIo, fmt::format("{}: {}", folder_, error.message())};
  std::string path = fmt::format("{}/merlin-{:%Y%m%d-%H%M%S}-frame-{}.png", folder_,
                                 fmt::localtime(std::time(nullptr)), frame->info.sequence);
  const auto written = render::writePng(path, frame->width, frame->height, frame->pixels);
  if (!written) return written.error();
  return path;
}

void SnapshotWriter::loop(const std::stop_token& stop) {
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [&] { return asked_; })) return;
      asked_ = false;
    }
    const auto path = write();
    if (path)
      logInfo("snapshot: {}", *path);
    else
      logWarning("snapshot: {}", path.error().what);
  }
}

}  // namespace merlin::wall
