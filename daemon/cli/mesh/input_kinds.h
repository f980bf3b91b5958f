// Recognises the kinds of inputs of `merlin mesh import` by their content.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace merlin::cli {

// Names of kinds in the arguments of merlin-import.
inline constexpr const char* kGridKind = "grid";
inline constexpr const char* kPointsKind = "points";

enum class InputReader { kRange, kMesh, kForeign };

struct InputKind {
  InputReader reader = InputReader::kMesh;
  // For kForeign: the kind (first argument of merlin-import), the usual ending of files in the
  // format (also an argument), and the name of the format for a person.
  std::string kind{}, ending{}, format{};

  // Returns whether the input is a range image or an elevation map, whichever reader reads it.
  bool isGrid() const { return reader == InputReader::kRange || kind == kGridKind; }
  bool isPoints() const { return kind == kPointsKind; }
  // Returns the unit of the coordinates: "m" if the format defines it, and for range images and
  // elevation maps, which their readers convert to metres; otherwise empty.
  std::string unit() const;
};

// Returns the kind of the file, by its content; the ending of its name counts only if the content
// is not conclusive. Returns nothing if no reader can read the file, or it cannot be opened.
std::optional<InputKind> inputKindOf(const std::string& path);

// Returns the names of the foreign formats, separated by commas, for messages and help.
std::string foreignFormats();

// Returns the foreign format of which these bytes are the beginning of a file; nothing if it is
// none. Pure.
std::optional<InputKind> foreignKindOf(std::string_view content);

}  // namespace merlin::cli
