#include "daemon/state/set_aside.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace merlin::state {
namespace {

const OutputForm& formOf(const Alignment& alignment) { return alignment.outputs.front().form; }

std::size_t placesOf(const Alignment& alignment) { return alignment.moved() + alignment.changes(); }

// Erases the oldest alignment of those that `which` selects while there are more than `most`.
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
  alignment.forgetSteps(kMostSteps, kMostAsidePlaces - std::min(moved, kMostAsidePlaces));
  const OutputForm form = formOf(alignment);
  std::erase_if(alignments_, [&](const Alignment& a) { return formOf(a) == form; });
  alignments_.push_back(std::move(alignment));
  keepNewest(alignments_, kMostAsideOfOutput,
             [&](const Alignment& a) { return formOf(a).output == form.output; });
  keepNewest(alignments_, kMostAside, [](const Alignment&) { return true; });
  std::size_t places = 0;
  for (const Alignment& a : alignments_) places += placesOf(a);
  while (alignments_.size() > 1 && places > kMostAsidePlaces) {
    places -= placesOf(alignments_.front());
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
