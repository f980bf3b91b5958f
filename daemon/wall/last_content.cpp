#include "daemon/wall/last_content.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace merlin::wall {

// Place of the content that the state names; nothing if the configuration lacks it.
std::optional<std::size_t> LastContent::placeInState() const {
  const std::string path = keeper_.state().content;
  if (path.empty()) return 0;
  const auto found = std::ranges::find(entries_, path, &ContentEntry::path);
  if (found == entries_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - entries_.begin());
}

std::size_t LastContent::first() const {
  if (const auto place = placeInState()) return *place;
  keeper_.addNotice(fmt::format(
      "content {}, which was shown last, is not in the configuration any more: the first "
      "one is shown",
      keeper_.state().content));
  return 0;
}

void LastContent::keep(std::size_t place) {
  if (kept_ == place) return;
  const bool first = !std::exchange(kept_, place);
  if (place >= entries_.size()) return;
  // If the kept content's file cannot be read yet, another one is shown first. The state is not
  // changed then, so that the next start tries the kept content again.
  if (first && !missing_.faultOf(placeInState().value_or(0)).empty()) return;
  const std::string path = place == 0 ? std::string() : entries_[place].path;
  if (keeper_.state().content != path) keeper_.change([&](state::State& s) { s.content = path; });
}

}  // namespace merlin::wall
