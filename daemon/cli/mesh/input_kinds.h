// The kinds of inputs of `merlin mesh import`, recognised by their content.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace merlin::cli {

inline constexpr const char* kGridKind = "grid";  // kinds of merlin-import
inline constexpr const char* kPointsKind = "points";

enum class InputReader { kRange, kMesh, kForeign };

struct InputKind {
  InputReader reader = InputReader::kMesh;
  // For kForeign: the arguments for merlin-import (kind, and the usual ending of the format's
  // files), and the format's name for a person.
  std::string kind{}, ending{}, format{};

  // Whether the input becomes a range image or an elevation map, with any reader.
  bool isGrid() const { return reader == InputReader::kRange || kind == kGridKind; }
  bool isPoints() const { return kind == kPointsKind; }
  // The unit of the coordinates: "m" if the format defines it, and for ranges and heights, which
  // the reader converts; otherwise empty.
  std::string unit() const;
};

// Reads the beginning of the file; the ending of its name counts only if the content is not
// conclusive. Nothing if there is no reader for the file, or it cannot be opened.
std::optional<InputKind> inputKindOf(const std::string& path);

// The foreign formats, for messages and help.
std::string foreignFormats();

// The row of the table of foreign formats for these bytes; nothing if there is none. Pure.
std::optional<InputKind> foreignKindOf(std::string_view content);

}  // namespace merlin::cli
