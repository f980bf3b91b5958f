#include "daemon/wall/notice.h"

#include <utility>

#include <fmt/format.h>

#include "daemon/base/printable_text.h"

namespace merlin::wall {

Result<Ok> Notice::show(const std::string& text) {
  if (text.empty() || text.size() > kMostBytes || !isText(text)) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("\"{}\" is not a sentence of 1 to {} bytes of text, or off",
                             excerpt(text), kMostBytes)};
  }
  const std::string shown = text == "off" ? "" : text;
  const Timestamp until = clock_.now() + kShown;
  if (const auto drawn = overlay_.show(shown, until); !drawn) return drawn;
  const std::lock_guard lock(mutex_);
  text_ = shown;
  until_ = until;
  return Ok{};
}

Result<Ok> Notice::stand(const std::string& text, Timestamp now) {
  constexpr Duration kAhead = std::chrono::seconds(1);  // renewed early, so as not to blink
  {
    const std::lock_guard lock(mutex_);
    if (now < until_ - (text_ == text ? kAhead : Duration{})) return Ok{};
  }
  return show(text);
}

void Notice::tend(Timestamp now) {
  std::string text;
  {
    const std::lock_guard lock(mutex_);
    if (now < until_) text = text_;
  }
  if (text == published_) return;
  shm::WallNotice notice{toNanoseconds(now), {}};
  text.copy(notice.text, kMostBytes);
  slot_.publish(notice);
  published_ = std::move(text);
}

}  // namespace merlin::wall
