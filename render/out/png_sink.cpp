#include "render/out/png_sink.h"

#include <utility>

#include "render/image/png_writer.h"

namespace merlin::render {
namespace {

constexpr auto kStep = std::chrono::milliseconds(500);

}  // namespace

PngFrameSink::PngFrameSink(PngSinkSettings settings, int width, int height, ThreadWatch& watch)
    : settings_(std::move(settings)),
      width_(width),
      height_(height),
      thread_(watch, "picture's file", [this](const std::stop_token& stop, Progress& progress) {
        encodeLoop(stop, progress);
      }) {}

PngFrameSink::~PngFrameSink() { thread_.stop(); }

void PngFrameSink::present(std::span<const std::uint8_t> pixels, const FrameInfo& info) {
  if (last_ != Timestamp{} && info.finished - last_ < fromSeconds(settings_.interval_s)) return;
  const std::lock_guard lock(mutex_);  // that nobody holds while a file is written
  if (!waiting_.empty()) return;
  last_ = info.finished;
  waiting_.assign(pixels.begin(), pixels.end());
  wake_.notify_one();
}

std::string PngFrameSink::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

void PngFrameSink::encodeLoop(const std::stop_token& stop, Progress& progress) {
  std::vector<std::uint8_t> pixels;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      const bool waits = wake_.wait_for(lock, stop, kStep, [&] { return !waiting_.empty(); });
      progress.step();
      if (!waits && stop.stop_requested()) return;
      if (!waits) continue;
      pixels = std::exchange(waiting_, {});
    }
    const Progress::Pause pause(progress);  // a disk may take its time
    const auto written = writePng(settings_.path, width_, height_, pixels);
    const std::lock_guard lock(mutex_);
    error_ = written ? std::string() : written.error().what;
  }
}

}  // namespace merlin::render
