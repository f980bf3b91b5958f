#include "render/panel/panel_plate.h"

#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace merlin::render::panel {
namespace {

using text::Align;
using text::Colour;
using text::Font;
using text::Surface;

constexpr Colour kGround{10, 14, 20, 214}, kKey{46, 54, 66, 235}, kKeyLit{36, 92, 150, 245};
constexpr Colour kKeyHovered{70, 82, 100, 245}, kKeyPressed{240, 190, 60};
constexpr Colour kBright{244, 246, 248}, kDim{164, 174, 186}, kOff{104, 112, 124};
constexpr Colour kOnPressed{20, 22, 26}, kEdge{255, 255, 255, 36}, kChosen{240, 190, 60};
constexpr Colour kRefused{255, 140, 120};

std::string withCommas(std::uint32_t number) {
  if (number >= 1'000'000) return fmt::format("{:.3g} M", number / 1e6);
  if (number >= 1'000) return fmt::format("{},{:03}", number / 1000, number % 1000);
  return std::to_string(number);
}

struct Value {
  std::string text, name;
  bool by_hand = false;
};

Value valueOf(FieldId id, const PanelFacts& facts, const PanelOptions& options) {
  switch (id) {
    case FieldId::kContent:
      return {facts.slide.empty() ? facts.content : facts.slide,
              facts.slide.empty() ? "content" : "slide"};
    case FieldId::kZoom: return {"", "zoom"};
    case FieldId::kRate: return {fmt::format("{:g} Hz", facts.rate_hz), "rate", facts.rate_by_hand};
    case FieldId::kDetail:
      return {facts.detail > 0 ? withCommas(facts.detail) : "-",
              facts.detail_unit.empty() ? "detail" : facts.detail_unit, facts.detail_by_hand};
    case FieldId::kLamp: return {"", "lamp"};
    case FieldId::kProjectors:
      if (!options.projectors) return {"", "input"};
      return {facts.projectors.empty() ? "?" : facts.projectors, "projectors"};
  }
  return {};
}

class Painter {
 public:
  Painter(const PanelView& view, const PanelOptions& options, const PanelFonts& fonts,
          const Surface& surface)
      : view_(view), options_(options), fonts_(fonts), surface_(surface) {}

  void field(const Field& field) const {
    const Value value = valueOf(field.id, view_.facts, options_);
    const Colour colour = value.by_hand ? kChosen : kBright;
    twoLines(field.at, value.text, value.name, colour, kDim);
  }

  void button(const Button& button) const {
    const ControlId id = button.id;
    const bool pressed = view_.pressed == id, lit = isLit(id, view_.facts, view_.by_ball);
    const bool works =
        actsOf(id) == Acts::kMotion || lit || requestOf(id, view_.facts, options_).has_value();
    Colour ground = view_.hovered == id && works ? kKeyHovered : lit ? kKeyLit : kKey;
    if (pressed) ground = kKeyPressed;
    const int radius = std::max(fonts_.text.metrics().em_px / 4, 2);
    if (view_.selected == id) {
      const int edge = std::max(fonts_.text.metrics().em_px / 7, 2);
      rounded(text::shrunk(button.at, -edge), radius + edge, kChosen);
      rounded(button.at, radius, {10, 14, 20});
    }
    rounded(button.at, radius, ground);
    const Colour colour = pressed ? kOnPressed : works ? kBright : kOff;
    const std::string_view label = labelOf(id, view_.facts, view_.by_ball);
    const bool fits = text::textWidth(fonts_.text, label) <= button.at.width - radius;
    if (id == ControlId::kMode)
      twoLines(button.at, label, "ball moves", colour, pressed ? kOnPressed : kDim);
    else
      text::drawTextIn(surface_, fits ? fonts_.text : fonts_.small, button.at, label, colour,
                       Align::kMiddle);
  }

  void notice(const Rect& at) const {
    const bool refused = !view_.facts.notice.empty();
    if (!refused && !view_.by_ball) return;
    text::drawTextIn(surface_, fonts_.small, at,
                     refused ? view_.facts.notice : "Ball: push selects, button presses",
                     refused ? kRefused : kChosen);
  }

 private:
  // Fills a rectangle with round corners of this radius [px].
  void rounded(const Rect& r, int radius, Colour colour) const {
    for (int y = 0; y < r.height; ++y) {
      const int from_edge = std::min(y, r.height - 1 - y);
      const int up = std::max(radius - from_edge, 0);
      int inset = 0;  // where the circle of the corner begins
      while (inset < radius && (radius - inset) * (radius - inset) + up * up > radius * radius + 1)
        ++inset;
      surface_.fill({r.x + inset, r.y + y, r.width - 2 * inset, 1}, colour);
    }
  }

  void twoLines(const Rect& at, std::string_view above, std::string_view below, Colour bright,
                Colour dim) const {
    const int whole = at.height;
    if (above.empty())
      return void(text::drawTextIn(surface_, fonts_.small, at, below, dim, Align::kMiddle));
    const int upper = whole * 57 / 100;
    text::drawTextIn(surface_, fonts_.text, {at.x, at.y, at.width, upper}, above, bright,
                     Align::kMiddle);
    text::drawTextIn(surface_, fonts_.small, {at.x, at.y + upper, at.width, whole - upper}, below,
                     dim, Align::kMiddle);
  }

  const PanelView& view_;
  const PanelOptions& options_;
  const PanelFonts& fonts_;
  Surface surface_;
};

}  // namespace

int smallSizeFor(int em_px) noexcept { return std::max(em_px * 3 / 4, 8); }

text::Plate drawPanel(const PanelView& view, const PanelLayout& layout, const PanelOptions& options,
                      const PanelFonts& fonts) {
  const Rect all{0, 0, layout.at.width, layout.at.height};
  text::Plate plate{layout.at,
                    std::vector<std::uint8_t>(std::size_t{4} * static_cast<std::size_t>(all.width) *
                                              static_cast<std::size_t>(all.height))};
  const Surface surface(plate.rgba, all.width, all.height);
  surface.fillWhole(kGround);
  surface.fill({0, 0, all.width, 1}, kEdge);
  surface.fill({0, all.height - 1, all.width, 1}, kEdge);
  const Painter painter(view, options, fonts, surface);
  for (const Field& field : layout.fields) painter.field(field);
  // Draws the selected button last, since its frame is larger than the button.
  for (const bool selected : {false, true}) {
    for (const Button& button : layout.buttons) {
      if ((view.selected == button.id) == selected) painter.button(button);
    }
  }
  painter.notice(layout.notice);
  return plate;
}

}  // namespace merlin::render::panel
