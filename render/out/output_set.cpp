#include "render/out/output_set.h"

#include <algorithm>
#include <utility>

namespace merlin::render::out {
namespace {

constexpr Duration kSecond = std::chrono::seconds(1);

}  // namespace

OutputSet::OutputSet(std::vector<NamedOutput> outputs) {
  for (NamedOutput& output : outputs) entries_.emplace_back(std::move(output));
}

void OutputSet::present(std::size_t i, const Signal& signal, const FrameInfo& info,
                        std::optional<Timestamp> deadline) {
  Entry& entry = entries_[i];
  if (checks_) checks_->meant(i, signal);
  if (!signal.pixels.empty()) *entry.drawn = signal.drawn;
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

bool OutputSet::draws() const {
  return std::ranges::any_of(entries_, [](const Entry& entry) { return entry.drawn->load(); });
}

std::string OutputSet::copyReason() const {
  for (const Entry& entry : entries_) {
    if (auto reason = entry.named.output->copyReason(); !reason.empty()) return reason;
  }
  return {};
}

std::string OutputSet::faultNow(std::size_t i) const {
  const Entry& entry = entries_[i];
  return entry.named.output->faultNow().value_or(entry.state.fault);
}

double OutputSet::shownHz(std::size_t i, Timestamp now) const {
  const auto& shown = entries_[i].shown;
  return static_cast<double>(std::count_if(
      shown.begin(), shown.end(), [&](Timestamp at) { return at > now - kSecond && at <= now; }));
}

std::optional<Vblank> OutputSet::vblank() const {
  for (const Entry& entry : entries_) {
    if (const auto vblank = entry.named.output->vblank()) return vblank;
  }
  return std::nullopt;
}

Result<std::string> OutputSet::mend() {
  std::string happened;
  std::optional<Errc> failed;
  for (Entry& entry : entries_) {
    const auto mended = entry.named.output->mend();
    if (!mended && !failed) failed = mended.error().code;
    const std::string& what = mended ? *mended : mended.error().what;
    if (!happened.empty() && !what.empty()) happened += "; ";
    happened += what;
  }
  if (failed) return Error{*failed, happened};
  return happened;
}

}  // namespace merlin::render::out
