// Computes the places of the controls of the operator's panel. Pure.
#pragma once

#include <optional>
#include <vector>

#include "render/panel/controls.h"
#include "render/text/surface.h"

namespace merlin::render::panel {

using text::Point;
using text::Rect;

struct Button {
  ControlId id{};
  Rect at;
};

// A value between buttons, with its name below.
enum class FieldId : std::uint8_t { kContent, kZoom, kRate, kDetail, kLamp, kProjectors };

struct Field {
  FieldId id{};
  Rect at;
};

// All rectangles but `at` are relative to the panel's upper left corner.
struct PanelLayout {
  Rect at;  // the panel's place in its tile
  std::vector<Button> buttons;
  std::vector<Field> fields;
  Rect notice;  // one line of text

  const Button* find(ControlId id) const noexcept;
};

// Lays out the panel for a tile of this size, whose text is `em_px` high: at the tile's right edge,
// in the middle of its height. Returns nothing if the tile is smaller than 320 x 240 pixels. The
// layout depends on nothing but these arguments.
std::optional<PanelLayout> layOutPanel(int tile_width_px, int tile_height_px, int em_px,
                                       const PanelOptions& options);

// Returns the button at a point of the tile; null if there is none.
const Button* buttonAt(const PanelLayout& layout, Point in_tile) noexcept;

// Returns the button that lies next to `from` in the direction of `right` and `down` (-1, 0, 1; one
// of them is 0); `from` itself at the panel's edge.
ControlId neighbourOf(const PanelLayout& layout, ControlId from, int right, int down) noexcept;

}  // namespace merlin::render::panel
