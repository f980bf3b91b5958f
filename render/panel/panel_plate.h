// Draws the operator's panel. Pure.
#pragma once

#include "render/panel/panel_input.h"
#include "render/text/operator_plate.h"

namespace merlin::render::panel {

// All that decides how the panel is drawn.
struct PanelView {
  PanelFacts facts;
  bool by_ball = false;
  std::optional<ControlId> hovered, selected, pressed;

  bool operator==(const PanelView&) const = default;
};

struct PanelFonts {
  text::Font text, small;
};

// Returns the em size of the small text that goes with text of em size `em_px` [px].
int smallSizeFor(int em_px) noexcept;

// Draws the panel as a plate; the same view gives the same bytes. Costs about as much as filling
// the panel three times.
text::Plate drawPanel(const PanelView& view, const PanelLayout& layout, const PanelOptions& options,
                      const PanelFonts& fonts);

}  // namespace merlin::render::panel
