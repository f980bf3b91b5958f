#include "daemon/page/frame_history.h"

#include <algorithm>

#include <fmt/format.h>

namespace merlin::page {
namespace {

constexpr std::size_t kKeptFrames = 2400, kSentFrames = 1200;

}  // namespace

void FrameHistory::follow(const shm::Channel<shm::FrameTrace>& trace, std::uint64_t generation) {
  if (generation != generation_) {
    frames_.clear();
    generation_ = generation;
    read_ = 0;
  }
  const std::uint64_t count = trace.count();
  if (count < read_) read_ = 0;  // a wall never does this, but others may write
  if (count - read_ >= shm::kHistory) read_ = count - (shm::kHistory - 1);
  for (; read_ < count; ++read_) {
    if (const auto frame = trace.at(read_)) add(*frame);
  }
}

void FrameHistory::add(const shm::FrameTrace& frame) {
  const double work_ms = static_cast<double>(frame.end_ns - frame.begin_ns) * 1e-6;
  frames_.push_back(
      {next_++, std::clamp(work_ms, 0.0, 1e6), frame.cost, frame.moving != 0, frame.late != 0});
  if (frames_.size() > kKeptFrames) frames_.pop_front();
}

std::string FrameHistory::since(std::uint64_t since) const {
  auto from = std::ranges::upper_bound(frames_, since, {}, &FrameTime::number);
  if (frames_.end() - from > static_cast<std::ptrdiff_t>(kSentFrames))
    from = frames_.end() - static_cast<std::ptrdiff_t>(kSentFrames);
  std::string list;
  for (; from != frames_.end(); ++from) {
    list += fmt::format("{}[{},{:.2f},{},{}]", list.empty() ? "" : ",", from->number, from->work_ms,
                        from->cost, (from->moving ? 1 : 0) + (from->late ? 2 : 0));
  }
  return fmt::format("{{\"next\":{},\"frames\":[{}]}}\n", next_, list);
}

}  // namespace merlin::page
