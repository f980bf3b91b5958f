#include "render/frame/fade.h"

#include <cassert>
#include <utility>

namespace merlin::render::frame {

std::span<std::uint8_t> Fade::next(std::span<const std::uint8_t> target) {
  assert(isOn());
  const int left = std::exchange(left_, left_ - 1);
  if (left == 1 || shown_.size() != target.size()) {
    keep(target);
    left_ = 0;
    return shown_;
  }
  // 16-bit arithmetic lets one vector instruction process many colour values.
  const auto share = static_cast<std::int16_t>(256 / left);
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    const auto way = static_cast<std::int16_t>(target[i] - shown_[i]);
    const auto step = static_cast<std::int16_t>(way * share / 256);
    shown_[i] = static_cast<std::uint8_t>(shown_[i] + step);
  }
  return shown_;
}

}  // namespace merlin::render::frame
