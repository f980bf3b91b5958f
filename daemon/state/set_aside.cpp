#include "daemon/state/set_aside.h"

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

namespace merlin::state {
namespace {

const OutputForm& formOf(const Alignment& alignment) { return alignment.outputs.front().form; }

std::size_t entriesOf(const Alignment& alignment) {
  return alignment.moved() + alignment.changes() + alignment.steps.size();
}

// Erases the oldest of the alignments that `which` selects until at most `most` of these are left.
template <typename Which>
void keepNewest(std::vector<Alignment>& alignments, std::size_t most, const Which& which) {
  auto count = static_cast<std::size_t>(std::count_if(alignments.begin(), alignments.end(), which));
  for (; count > most; --count)
    alignments.erase(std::find_if(alignments.begin(), alignments.end(), which));
}

}  // namespace

void SetAside::add(Alignment alignment) {
  if (alignment.isNothing()) return;
  assert(alignment.outputs.size() == 1);
  const std::size_t moved = alignment.moved();
  alignment.forgetSteps(kMostSteps, kMostAsideEntries - std::min(moved, kMostAsideEntries));
  const std::string output = formOf(alignment).output;
  alignments_.push_back(std::move(alignment));
  keepNewest(alignments_, kMostAsideOfOutput,
             [&](const Alignment& a) { return formOf(a).output == output; });
  keepNewest(alignments_, kMostAside, [](const Alignment&) { return true; });
  std::size_t entries = 0;
  for (const Alignment& a : alignments_) entries += entriesOf(a);
  while (alignments_.size() > 1 && entries > kMostAsideEntries) {
    entries -= entriesOf(alignments_.front());
    alignments_.erase(alignments_.begin());
  }
}

std::optional<Alignment> SetAside::take(const std::function<bool(const Alignment&)>& fits) {
  for (std::size_t i = alignments_.size(); i-- > 0;) {
    if (!fits(alignments_[i])) continue;
    Alignment taken = std::move(alignments_[i]);
    alignments_.erase(alignments_.begin() + static_cast<std::ptrdiff_t>(i));
    return taken;
  }
  return std::nullopt;
}

}  // namespace merlin::state
