// SignalTaps: copies the next signal of an output, as it is sent, to shared memory for `merlin
// snapshot --output`. This works for outputs of every kind.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "render/frame/signal_watcher.h"
#include "render/out/shared_frame.h"

namespace merlin::wall {

struct TappedOutput {
  std::string name;
  int width = 0, height = 0;  // size of its signal [px]
};

// Thread-safe, except for wants() and see(), which are for the wall's thread only.
class SignalTaps final : public render::frame::SignalWatcher {
 public:
  // `instance`: name of the daemon's instance. `generation`: shm::newGeneration(). `clock` must
  // outlive this object.
  SignalTaps(const std::string& instance, std::vector<TappedOutput> outputs,
             std::uint64_t generation, const Clock& clock);

  // Requests a copy of the next signal of an output, and returns at once. The result is the name of
  // the segment to which the signal will be copied; the segment has the layout of the wall's shared
  // frame (render/out/shared_frame_layout.h) and room for three signals, and exists for at least a
  // minute. Errors: kInvalidArgument (there is no such output), those of SharedFrameOutput::make(),
  // e.g. kIo (not enough memory).
  Result<std::string> ask(const std::string& output);

  // Removes the segments that were not requested in the last minute. To be called regularly.
  void tend(Timestamp now);

  bool wants(std::size_t i) const override { return taps_[i]->wanted; }
  // Copies the signal of output i. If ask() or tend() uses the segment at this moment, the signal
  // of the next frame is copied instead.
  void see(std::size_t i, const render::out::Signal& signal,
           const render::out::FrameInfo& info) override;

 private:
  struct Tap {
    TappedOutput output;
    std::string segment;  // name of the segment
    std::atomic<bool> wanted{false};
    std::mutex mutex{};  // guards the next two members
    Timestamp asked{};
    std::unique_ptr<render::out::SharedFrameOutput> memory{};
  };

  std::uint64_t generation_;
  const Clock& clock_;
  std::vector<std::unique_ptr<Tap>> taps_;  // indexed by output number
};

}  // namespace merlin::wall
