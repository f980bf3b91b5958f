// Draws the operator's panel. Pure.
#pragma once

#include "render/panel/panel_input.h"
#include "render/text/operator_plate.h"

namespace merlin::render::panel {

// What is drawn.
struct PanelView {
  PanelFacts facts;
  bool by_ball = false;
  std::optional<ControlId> hovered, selected, pressed;

  bool operator==(const PanelView&) const = default;
};

struct PanelFonts {
  text::Font text, small;
};

// Em size of the small text beside text of this size [px].
int smallSizeFor(int em_px) noexcept;

// The same view gives the same bytes. Costs about as much as filling the panel three times.
text::Plate drawPanel(const PanelView& view, const PanelLayout& layout, const PanelOptions& options,
                      const PanelFonts& fonts);

}  // namespace merlin::render::panel
