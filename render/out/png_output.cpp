#include "render/out/png_output.h"

#include <utility>

#include "render/image/png_writer.h"

namespace merlin::render::out {
namespace {

constexpr auto kLongestWait = std::chrono::milliseconds(500);

}  // namespace

PngOutput::PngOutput(std::string path, double interval_s, ThreadWatch& watch)
    : PngOutput(std::move(path), interval_s, watch, image::writePng) {}

PngOutput::PngOutput(std::string path, double interval_s, ThreadWatch& watch, Write write)
    : path_(std::move(path)),
      write_(std::move(write)),
      interval_s_(interval_s),
      thread_(watch, "PNG output", [this](const std::stop_token& stop, Progress& progress) {
        encodeLoop(stop, progress);
      }) {}

PngOutput::~PngOutput() { thread_.stop(); }

bool PngOutput::mayTake(const FrameInfo& info) const {
  const Timestamp last = last_.load();
  return last == Timestamp{} || info.finished - last >= fromSeconds(interval_s_);
}

bool PngOutput::wantsFrame(Timestamp now) const {
  return skipped_.load() && mayTake({.finished = now});
}

Result<std::optional<Timestamp>> PngOutput::present(const Signal& signal, const FrameInfo& info) {
  const bool due = mayTake(info);
  const std::lock_guard lock(mutex_);  // never held while a file is written
  std::optional<Timestamp> shown;
  if (due && waiting_.empty()) {
    last_ = info.finished;
    waiting_.assign(signal.pixels.begin(), signal.pixels.end());
    width_ = signal.width;
    height_ = signal.height;
    wake_.notify_one();
    shown = info.finished;
  }
  skipped_ = !shown;
  if (fault_) return *fault_;
  return shown;
}

void PngOutput::encodeLoop(const std::stop_token& stop, Progress& progress) {
  std::vector<std::uint8_t> pixels;
  int width = 0, height = 0;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      const bool waits =
          wake_.wait_for(lock, stop, kLongestWait, [&] { return !waiting_.empty(); });
      progress.step();
      if (!waits && stop.stop_requested()) return;
      if (!waits) continue;
      pixels = std::exchange(waiting_, {});
      width = width_;
      height = height_;
    }
    const Progress::Pause pause(progress);  // writing to disk may take long
    const auto written = write_(path_, width, height, pixels);
    const std::lock_guard lock(mutex_);
    fault_ = written ? std::nullopt : std::optional(written.error());
  }
}

}  // namespace merlin::render::out
