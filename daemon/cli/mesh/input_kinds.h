// What an input of `merlin mesh import` is, by its content: one table.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace merlin::cli {

inline constexpr const char* kGridKind = "grid";  // of merlin-import
inline constexpr const char* kPointsKind = "points";

enum class InputReader { kRange, kMesh, kForeign };

struct InputKind {
  InputReader reader = InputReader::kMesh;
  // Of kForeign: what merlin-import is told (its kind, and the ending of the format's usual name),
  // and the format's name for a person.
  std::string kind{}, ending{}, format{};

  // Whether it becomes a range image or an elevation map, by whichever reader.
  bool isGrid() const { return reader == InputReader::kRange || kind == kGridKind; }
  bool isPoints() const { return kind == kPointsKind; }
  // The unit of its coordinates: "m" where its format's rules say so, and of ranges and heights,
  // which reading converts; else empty.
  std::string unit() const;
};

// Reads the file's beginning; the name's ending counts only where the content tells nothing.
// Nothing if no reader is for it, or it cannot be opened.
std::optional<InputKind> inputKindOf(const std::string& path);

// The foreign formats, for messages and help.
std::string foreignFormats();

// The row of the table of foreign formats for these bytes; nothing if there is none. Pure.
std::optional<InputKind> foreignKindOf(std::string_view content);

}  // namespace merlin::cli
