#include "daemon/page/shown_pictures.h"

#include <algorithm>
#include <utility>

namespace merlin::page {

bool ShownPictures::keep(const std::string& name, std::string jpeg, std::uint64_t number) {
  auto place = std::find_if(pictures_.begin(), pictures_.end(),
                            [&](const Picture& p) { return p.name == name; });
  if (place != pictures_.end() && *place->jpeg == jpeg) return false;
  if (place == pictures_.end() && pictures_.size() < kMost)
    place = pictures_.insert(place, Picture{});
  else if (place == pictures_.end())
    place =
        std::min_element(pictures_.begin(), pictures_.end(),
                         [](const Picture& a, const Picture& b) { return a.number < b.number; });
  *place = {name, std::make_shared<const std::string>(std::move(jpeg)), number};
  return true;
}

}  // namespace merlin::page
