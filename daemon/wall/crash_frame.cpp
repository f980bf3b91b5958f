#include "daemon/wall/crash_frame.h"

#include <condition_variable>
#include <mutex>
#include <utility>

#include "daemon/base/log.h"
#include "daemon/wall/snapshot_writer.h"

namespace merlin::wall {
namespace {

constexpr auto kBeat = std::chrono::milliseconds(200);

}  // namespace

std::optional<render::out::CapturedFrame> frameOfCrash(const std::string& name) {
  if (SharedMemory::owned(name)) return std::nullopt;
  auto frame = render::out::captureFrame(name, SharedMemory::From::kOwnUserOrRoot);
  return frame ? std::optional(*std::move(frame)) : std::nullopt;
}

CrashFrame::CrashFrame(render::out::CapturedFrame frame, DatedFiles files, ThreadWatch& watch)
    : frame_(std::move(frame)),
      files_(std::move(files)),
      thread_(watch, "frame of a crash", [this](const std::stop_token& stop, Progress& progress) {
        giveWay();
        write(progress);
        std::mutex mutex;
        std::unique_lock lock(mutex);
        std::condition_variable_any never;
        while (!stop.stop_requested()) {  // reports progress, as watched threads must
          progress.step();
          never.wait_for(lock, stop, kBeat, [] { return false; });
        }
      }) {}

CrashFrame::~CrashFrame() { thread_.stop(); }

void CrashFrame::write(Progress& progress) {
  const Progress::Pause pause(progress);  // writing to a disk may take long
  const auto path = saveFrame(std::exchange(frame_, {}), files_);
  if (path)
    logWarning("the wall's process was killed or crashed; the last frame before that is in {}",
               *path);
  else
    logWarning("the last frame before the wall's process was killed or crashed is lost: {}",
               path.error().what);
}

}  // namespace merlin::wall
