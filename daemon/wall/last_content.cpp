#include "daemon/wall/last_content.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/absolute_path.h"

namespace merlin::wall {
namespace {

// Whether the path of a content ends with `relative`, a path that an earlier version saved; the
// folder to which that path was relative is not known.
bool endsWith(const ContentEntry& entry, const std::string& relative) {
  std::string_view end = relative;
  while (end.starts_with("../")) end.remove_prefix(3);
  return absolutePath(entry.path).ends_with(fmt::format("/{}", end));
}

}  // namespace

// Returns the place of the content that the state names; nothing if the configuration lacks it.
std::optional<std::size_t> LastContent::placeInState() const {
  const std::string path = keeper_.state().content;
  if (path.empty()) return 0;
  auto found = std::ranges::find_if(
      entries_, [&](const ContentEntry& e) { return absolutePath(e.path) == absolutePath(path); });
  const std::filesystem::path saved(path);
  if (found == entries_.end() && saved.is_relative()) {
    const std::string relative = saved.lexically_normal().string();
    found = std::ranges::find_if(entries_,
                                 [&](const ContentEntry& e) { return endsWith(e, relative); });
  }
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
  // If the file of the saved content cannot be read yet at a start, another content is shown first.
  // The state does not change then, so that the next start tries the saved content again.
  if (first && !missing_.faultOf(placeInState().value_or(0)).empty()) return;
  const std::string path = place == 0 ? std::string() : absolutePath(entries_[place].path);
  if (keeper_.state().content != path) keeper_.change([&](state::State& s) { s.content = path; });
}

}  // namespace merlin::wall
