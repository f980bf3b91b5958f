// Fade: cross-fades from the frame shown to another one within a few frames, so that the change is
// not abrupt.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace merlin::render::frame {

// Thread-bound.
class Fade {
 public:
  // Copies the frame that is shown now.
  void keep(std::span<const std::uint8_t> shown) { shown_.assign(shown.begin(), shown.end()); }

  // Starts a fade from the frame shown to another one, over that many frames. REQUIRES: frames >=
  // 1.
  void begin(int frames) noexcept { left_ = frames; }
  void stop() noexcept { left_ = 0; }
  bool isOn() const noexcept { return left_ > 0; }

  // Returns the next frame of the fade; the last one equals `target` in every byte. If the size of
  // `target` differs, it is returned at once. O(bytes), about 1 ms for four million. REQUIRES:
  // isOn().
  std::span<std::uint8_t> next(std::span<const std::uint8_t> target);

 private:
  std::vector<std::uint8_t> shown_;
  int left_ = 0;  // frames of the fade still to come
};

}  // namespace merlin::render::frame
