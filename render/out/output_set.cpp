#include "render/out/output_set.h"

#include <algorithm>
#include <utility>

namespace merlin::render {
namespace {

constexpr Duration kSecond = std::chrono::seconds(1);

}  // namespace

OutputSet::OutputSet(std::vector<NamedOutput> outputs) {
  for (NamedOutput& output : outputs) entries_.emplace_back(std::move(output));
}

void OutputSet::present(std::size_t i, const Signal& signal, const FrameInfo& info,
                        std::optional<Timestamp> deadline) {
  Entry& entry = entries_[i];
  const auto shown = entry.named.output->present(signal, info);
  entry.state.fault = shown ? std::string() : shown.error().what;
  if (!shown || !*shown) return;
  ++entry.state.frames;
  if (deadline) {
    ++entry.state.due;
    if (**shown > *deadline) ++entry.state.late;
  }
  entry.shown.push_back(**shown);
  while (**shown - entry.shown.front() > kSecond) entry.shown.pop_front();
}

double OutputSet::shownHz(std::size_t i, Timestamp now) const {
  const auto& shown = entries_[i].shown;
  return static_cast<double>(std::count_if(
      shown.begin(), shown.end(), [&](Timestamp at) { return at > now - kSecond && at <= now; }));
}

Result<std::string> OutputSet::mend() {
  std::string happened;
  for (Entry& entry : entries_) {
    auto mended = entry.named.output->mend();
    if (!mended) return mended;
    if (!happened.empty() && !mended->empty()) happened += "; ";
    happened += *mended;
  }
  return happened;
}

}  // namespace merlin::render
