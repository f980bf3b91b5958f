// Reads lines of text-based mesh formats, in which "#" begins a comment. Private to render/mesh/io.
#pragma once

#include "daemon/base/words.h"

namespace merlin::render::mesh {

// Removes the first line from `text`; returns it without its line feed and its comment.
inline std::string_view takeUncommented(std::string_view& text) {
  const std::string_view line = takeLine(text);
  return line.substr(0, line.find('#'));
}

}  // namespace merlin::render::mesh
