// Fade: the picture that is shown becomes another one in a few frames, so that it does not pop.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace merlin::render {

// Thread-bound.
class Fade {
 public:
  // Keeps the picture that is shown now.
  void keep(std::span<const std::uint8_t> shown) { shown_.assign(shown.begin(), shown.end()); }

  // From what is shown to another picture, in so many frames. REQUIRES: frames >= 1.
  void begin(int frames) noexcept { left_ = frames; }
  void stop() noexcept { left_ = 0; }
  bool isOn() const noexcept { return left_ > 0; }

  // The next frame on the way to `target`; the last one is that, byte by byte. A picture of another
  // size is that at once. O(bytes), about 1 ms for four million. REQUIRES: isOn().
  std::span<std::uint8_t> next(std::span<const std::uint8_t> target);

 private:
  std::vector<std::uint8_t> shown_;
  int left_ = 0;  // frames
};

}  // namespace merlin::render
