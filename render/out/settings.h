// Settings of outputs.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"
#include "render/tiles/settings.h"

namespace merlin::render {

// In the order of kOutputKindNames.
enum class OutputKind { kSharedMemory, kPng };
inline constexpr const char* kOutputKindNames[] = {"shared_memory", "png"};
inline constexpr const char* nameOf(OutputKind kind) {
  return kOutputKindNames[static_cast<int>(kind)];
}

// How a projector or display is mounted: its picture is mirrored first (rear projection), then
// turned clockwise. In the order of kMirrorNames and kTurnNames.
enum class Mirror { kNone, kHorizontal, kVertical };
enum class Turn { k0, k90, k180, k270 };
inline constexpr const char* kMirrorNames[] = {"none", "horizontal", "vertical"};
inline constexpr const char* kTurnNames[] = {"0", "90", "180", "270"};

// A tile's place in the picture that an output is sent.
struct PlacedTile {
  std::string tile;  // its name
  int x = 0, y = 0;  // of the upper left corner, after mirroring and turning [px]
  Mirror mirror = Mirror::kNone;
  Turn turn = Turn::k0;
};

struct OutputSettings {
  OutputKind kind = OutputKind::kSharedMemory;
  std::string name{};               // empty: the kind's
  std::string path{};               // png: the file
  double interval_s = 60;           // png: between two files, at least
  std::vector<PlacedTile> tiles{};  // what it is sent; empty: the whole frame

  std::string shownName() const { return name.empty() ? nameOf(kind) : name; }
};

// Number of outputs that shared memory has room to report on.
inline constexpr std::size_t kMostOutputs = 8;

// Finds what no wall can have: no output or more than kMostOutputs, two of one name, a name of more
// than 23 characters, two in shared memory, a PNG file without a path, a setting of another kind; a
// placed tile that `tiles` lacks or that overlaps another on its output. Pure.
SettingFaults validate(const std::vector<OutputSettings>& outputs, const TilesSettings& tiles);

}  // namespace merlin::render
