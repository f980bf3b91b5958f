#include "daemon/wall/snapshot_writer.h"

#include <ctime>
#include <utility>

#include "daemon/base/log.h"
#include "render/image/png_writer.h"

namespace merlin::wall {
namespace {

constexpr auto kWriterStep = std::chrono::milliseconds(500);

}  // namespace

Result<std::string> saveFrame(const render::out::CapturedFrame& frame, const DatedFiles& files) {
  const std::time_t now = std::time(nullptr);
  auto path = files.next(now);
  if (!path) return path;
  const auto written = render::image::writePng(*path, frame.width, frame.height, frame.pixels);
  if (!written) return written.error();
  files.removeOldest(now);
  return path;
}

SnapshotWriter::SnapshotWriter(std::string framebuffer, DatedFiles files, ThreadWatch& watch)
    : framebuffer_(std::move(framebuffer)),
      files_(std::move(files)),
      thread_(watch, "snapshots",
              [this](const std::stop_token& stop, Progress& progress) { loop(stop, progress); }) {}

SnapshotWriter::~SnapshotWriter() { thread_.stop(); }

void SnapshotWriter::take() {
  const std::lock_guard lock(mutex_);
  asked_ = true;
  wake_.notify_one();
}

Result<std::string> SnapshotWriter::write() const {
  const auto frame = render::out::captureFrame(framebuffer_, SharedMemory::From::kOwnUserOrRoot);
  if (!frame) return frame.error();
  return saveFrame(*frame, files_);
}

void SnapshotWriter::loop(const std::stop_token& stop, Progress& progress) {
  giveWay();
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      const bool asked = wake_.wait_for(lock, stop, kWriterStep, [&] { return asked_; });
      progress.step();
      if (!asked && stop.stop_requested()) return;
      if (!asked) continue;
      asked_ = false;
    }
    const Progress::Pause pause(progress);  // writing to a disk may take long
    const auto path = write();
    if (path) ++written_;
    if (path)
      logInfo("snapshot: {}", *path);
    else
      logWarning("snapshot: {}", path.error().what);
  }
}

}  // namespace merlin::wall
