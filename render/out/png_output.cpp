#include "render/out/png_output.h"

#include <utility>

#include "render/image/png_writer.h"

namespace merlin::render {
namespace {

constexpr auto kStep = std::chrono::milliseconds(500);

}  // namespace

PngOutput::PngOutput(std::string path, double interval_s, ThreadWatch& watch)
    : path_(std::move(path)),
      interval_s_(interval_s),
      thread_(watch, "PNG output", [this](const std::stop_token& stop, Progress& progress) {
        encodeLoop(stop, progress);
      }) {}

PngOutput::~PngOutput() { thread_.stop(); }

Result<std::optional<Timestamp>> PngOutput::present(const Signal& signal, const FrameInfo& info) {
  const bool due = last_ == Timestamp{} || info.finished - last_ >= fromSeconds(interval_s_);
  const std::lock_guard lock(mutex_);  // that nobody holds while a file is written
  std::optional<Timestamp> shown;
  if (due && waiting_.empty()) {
    last_ = info.finished;
    waiting_.assign(signal.pixels.begin(), signal.pixels.end());
    width_ = signal.width;
    height_ = signal.height;
    wake_.notify_one();
    shown = info.finished;
  }
  if (fault_) return *fault_;
  return shown;
}

void PngOutput::encodeLoop(const std::stop_token& stop, Progress& progress) {
  std::vector<std::uint8_t> pixels;
  int width = 0, height = 0;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      const bool waits = wake_.wait_for(lock, stop, kStep, [&] { return !waiting_.empty(); });
      progress.step();
      if (!waits && stop.stop_requested()) return;
      if (!waits) continue;
      pixels = std::exchange(waiting_, {});
      width = width_;
      height = height_;
    }
    const Progress::Pause pause(progress);  // a disk may take its time
    const auto written = writePng(path_, width, height, pixels);
    const std::lock_guard lock(mutex_);
    fault_ = written ? std::nullopt : std::optional(written.error());
  }
}

}  // namespace merlin::render
