#include "render/out/window/settings.h"

#include <fmt/format.h>

namespace merlin::render::out {

SettingFaults validate(const WindowSettings& w) {
  SettingFaults faults;
  if (w.title.size() > kLongestTitle) {
    faults.push_back({"/title", fmt::format("has {} bytes; at most {} are allowed", w.title.size(),
                                            kLongestTitle)});
  }
  if ((w.width > 0) != (w.height > 0)) {
    faults.push_back({w.width > 0 ? "/height" : "/width",
                      "is 0, and the other side of the window is not: give both, or neither"});
  }
  if (!w.fullscreen) return faults;
  const WindowSettings normal;
  const auto unused = [&](const char* pointer) {
    faults.push_back(
        {pointer, "has no meaning for a window that is fullscreen: remove one of them"});
  };
  if (w.x != normal.x) unused("/x");
  if (w.y != normal.y) unused("/y");
  if (w.width != normal.width) unused("/width");
  if (w.height != normal.height) unused("/height");
  if (w.border != normal.border) unused("/border");
  return faults;
}

}  // namespace merlin::render::out
