// Settings of outputs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/setting_fault.h"
#include "render/correct/settings.h"
#include "render/out/kms/settings.h"
#include "render/out/window/settings.h"
#include "render/tiles/settings.h"

namespace merlin::render::out {

// In the order of kOutputKindNames.
enum class OutputKind { kSharedMemory, kPng, kWindow, kKms };
inline constexpr const char* kOutputKindNames[] = {"shared_memory", "png", "window", "kms"};
inline constexpr const char* nameOf(OutputKind kind) {
  return kOutputKindNames[static_cast<int>(kind)];
}

// How a projector or display is mounted: its picture is first mirrored (rear projection), then
// rotated clockwise. In the order of kMirrorNames and kTurnNames.
enum class Mirror { kNone, kHorizontal, kVertical };
enum class Turn { k0, k90, k180, k270 };
inline constexpr const char* kMirrorNames[] = {"none", "horizontal", "vertical"};
inline constexpr const char* kTurnNames[] = {"0", "90", "180", "270"};

// A tile's position in the picture that an output is sent.
struct PlacedTile {
  std::string tile;  // name of the tile
  int x = 0, y = 0;  // upper left corner, after mirroring and rotation [px]
  Mirror mirror = Mirror::kNone;
  Turn turn = Turn::k0;
  // Not empty: name of a tile of the same size with the right eye's picture; both are shown as one
  // anaglyph. render/stereo sets it.
  std::string right_eye{};
};

struct OutputSettings {
  OutputKind kind = OutputKind::kSharedMemory;
  std::string name{};               // empty: the kind's name
  std::string path{};               // png: path of the file
  double interval_s = 60;           // png: minimum time between two files
  WindowSettings window{};          // window: what it looks like
  kms::KmsSettings kms{};           // kms: which display
  std::vector<PlacedTile> tiles{};  // tiles that the output is sent; empty: the whole frame
  correct::CorrectionSettings correction{};  // applied to the picture made of `tiles`
  // Time between two checks of what the output really shows [s]; 0: no checks. Kinds shared_memory
  // and kms.
  double check_s = 5;

  std::string shownName() const { return name.empty() ? nameOf(kind) : name; }
};

// Part of a picture [px].
struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Rectangle&) const = default;
  bool overlaps(const Rectangle& o) const {
    return x < o.x + o.width && o.x < x + width && y < o.y + o.height && o.y < y + height;
  }
};
// Returns the rectangle that a placed tile covers in the picture of its output. `tile` is the tile
// in `all` that `placed` names.
Rectangle placeOf(const PlacedTile& placed, const tiles::TileSettings& tile,
                  const tiles::TilesSettings& all);

// Size of the picture that an output is sent; a correction does not change it.
struct PictureSize {
  int width = 0, height = 0;  // [px]
};
// Returns the size of the picture that `output` is sent; nothing if a placed tile's name is not one
// of `tiles`.
std::optional<PictureSize> pictureSize(const OutputSettings& output,
                                       const tiles::TilesSettings& tiles);

// Maximum number of outputs, for whose states shared memory has room.
inline constexpr std::size_t kMostOutputs = 32;

// Checks for: no output or more than kMostOutputs; two outputs with one name; a name of more than
// 23 characters; two outputs in shared memory; a PNG output without a path; two outputs that write
// the same file; a setting that belongs to another kind; faults of a window; faults of an output of
// kind kms, two of them on one display, or a named mode that is smaller than the picture; a placed
// tile that is not in `tiles` or overlaps another one on its output; faults of the correction.
// Pure.
SettingFaults validate(const std::vector<OutputSettings>& outputs,
                       const tiles::TilesSettings& tiles);

}  // namespace merlin::render::out
