#include "render/text/operator_plate.h"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace merlin::render::text {
namespace {

constexpr Colour kGround{10, 14, 20, 190}, kRule{255, 255, 255, 40};
constexpr Colour kBright{244, 246, 248}, kDim{164, 174, 186};
constexpr Colour kGood{86, 204, 120}, kWaiting{240, 190, 60}, kBad{255, 82, 70};
constexpr Colour kInTime{110, 180, 240}, kDeadline{240, 240, 240, 150};

Colour colourOf(DeviceLight light) {
  if (light == DeviceLight::kGood) return kGood;
  return light == DeviceLight::kWaiting ? kWaiting : kBad;
}

// Formats 1234567 as "1,234,567".
std::string grouped(std::uint32_t number) {
  const std::string digits = std::to_string(number);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

Plate makePlate(const Rect& at) {
  return {at, std::vector<std::uint8_t>(std::size_t{4} * static_cast<std::size_t>(at.width) *
                                        static_cast<std::size_t>(at.height))};
}

// Draws rows of a plate, one below the other.
class Rows {
 public:
  Rows(const Surface& surface, const PlateFonts& fonts, const Rect& inside)
      : surface_(surface), fonts_(fonts), left_(inside) {}

  // Returns the rectangle of the next row, which is `height_px` high.
  Rect take(int height_px) {
    const Rect taken{left_.x, left_.y, left_.width, std::min(height_px, left_.height)};
    left_.y += taken.height;
    left_.height -= taken.height;
    return taken;
  }

  void rule() {
    const Rect space = take(fonts_.text.metrics().em_px * 3 / 5);
    surface_.fill({space.x, space.y + space.height / 2, space.width, 1}, kRule);
  }

  // Draws a name on the left and its value in a column that begins at the same place in all rows.
  void row(std::string_view name, std::string_view value, Colour colour = kBright) {
    const Rect line = take(lineHeight());
    drawTextIn(surface_, fonts_.text, nameIn(line), name, kDim);
    drawTextIn(surface_, fonts_.text, valueIn(line), value, colour);
  }
  Rect nameIn(const Rect& line) const {
    const int em = fonts_.text.metrics().em_px;
    return {line.x, line.y, std::min(valueColumn() - em / 3, line.width), line.height};
  }
  Rect valueIn(const Rect& line) const {
    const int column = std::min(valueColumn(), line.width);
    return {line.x + column, line.y, line.width - column, line.height};
  }

  int lineHeight() const { return lineHeightOf(fonts_.text); }
  // Returns the place of the column of values [px]: far enough for "triangles", and for "tracker"
  // behind its dot.
  int valueColumn() const { return fonts_.text.metrics().em_px * 11 / 2; }
  static int lineHeightOf(const Font& font) { return font.metrics().em_px * 29 / 20; }

  const Surface& surface() const { return surface_; }
  const PlateFonts& fonts() const { return fonts_; }

 private:
  Surface surface_;
  PlateFonts fonts_;
  Rect left_;
};

void drawRate(const OperatorFacts& facts, Rows& rows) {
  const Font& heading = rows.fonts().heading;
  const Rect line = rows.take(Rows::lineHeightOf(heading));
  const bool held = facts.rate_held_hz > 0.97 * facts.rate_asked_hz;
  const int width =
      drawTextIn(rows.surface(), heading, line, fmt::format("{:.1f} Hz", facts.rate_held_hz),
                 held ? kBright : kWaiting);
  const int gap = heading.metrics().em_px / 2;
  const Rect rest{line.x + width + gap, line.y, std::max(line.width - width - gap, 0), line.height};
  std::string asked = fmt::format("of {:g} asked", facts.rate_asked_hz);
  if (facts.rate_now_hz < 0.99 * facts.rate_asked_hz)
    asked = fmt::format("of {:g}, lowered to {:.3g}", facts.rate_asked_hz, facts.rate_now_hz);
  drawTextIn(rows.surface(), rows.fonts().text, rest, asked, kDim, Align::kRight);
}

// Draws bars up to twice the period, and a line for the deadline.
void drawChart(const OperatorFacts& facts, Rows& rows) {
  const Rect chart = rows.take(4 * rows.lineHeight());
  const Surface& surface = rows.surface();
  surface.fill(chart, {0, 0, 0, 120});
  const auto edge = [&chart](std::size_t column) {
    return chart.x + static_cast<int>(column) * chart.width / static_cast<int>(kChartColumns);
  };
  for (std::size_t i = 0; i < kChartColumns; ++i) {
    const ChartColumn& column = facts.chart[i];
    const int height = std::min(chart.height * column.percent / 200, chart.height);
    surface.fill({edge(i), chart.y + chart.height - height, edge(i + 1) - edge(i), height},
                 column.late ? kBad : kInTime);
  }
  surface.fill({chart.x, chart.y + chart.height / 2, chart.width, 1}, kDeadline);
  const Rect above = shrunk({chart.x, chart.y, chart.width, chart.height / 2}, 2);
  const auto note = [&](const std::string& text, Align align, Colour colour) {
    drawTextIn(surface, rows.fonts().text,
               {above.x, above.y, above.width, std::min(rows.lineHeight(), above.height)}, text,
               colour, align);
  };
  if (facts.rate_now_hz > 0)
    note(fmt::format("{:.1f} ms", 1000 / facts.rate_now_hz), Align::kLeft, kDim);
  note(fmt::format("{:.1f} % late", facts.late_percent), Align::kRight,
       facts.late_percent > 1 ? kBad : kDim);
}

void drawState(const OperatorFacts& facts, Rows& rows) {
  const std::string detail =
      facts.full_detail ? fmt::format("{} (all)", grouped(facts.cost))
                        : fmt::format("{} of {}", grouped(facts.cost), grouped(facts.full_cost));
  std::string unit = facts.cost_unit.empty() ? "Detail" : facts.cost_unit;
  if (unit[0] >= 'a' && unit[0] <= 'z') unit[0] = static_cast<char>(unit[0] - 'a' + 'A');
  rows.row(unit, detail);
  rows.row("Budget", grouped(facts.budget) + (facts.budget_by_hand ? " by hand" : ""),
           facts.budget_by_hand ? kWaiting : kBright);
  rows.rule();
  rows.row("Content", facts.content);
  if (!facts.slide.empty()) rows.row("Slide", facts.slide);
  rows.row("Ball", facts.mode);
  rows.row("Posture", facts.posture.empty() ? "none" : facts.posture,
           facts.posture.empty() ? kDim : kBright);
}

void drawDevices(const OperatorFacts& facts, Rows& rows) {
  if (facts.devices_missing) return rows.row("Devices", "not known", kBad);
  if (facts.devices.empty()) return rows.row("Devices", "none configured", kDim);
  const int em = rows.fonts().text.metrics().em_px;
  for (const DeviceFact& device : facts.devices) {
    const Rect line = rows.take(rows.lineHeight());
    rows.surface().disc({line.x, line.y, em, line.height}, em * 7 / 10, colourOf(device.light));
    Rect name = rows.nameIn(line);
    name.x += em * 3 / 2;
    name.width = std::max(name.width - em * 3 / 2, 0);
    drawTextIn(rows.surface(), rows.fonts().text, name, device.name, kBright);
    drawTextIn(rows.surface(), rows.fonts().text, rows.valueIn(line), device.state,
               device.light == DeviceLight::kGood ? kDim : kBright);
  }
}

int stateHeight(const OperatorFacts& facts, const PlateFonts& fonts) {
  const int line = Rows::lineHeightOf(fonts.text), rule = fonts.text.metrics().em_px * 3 / 5;
  const auto devices = static_cast<int>(std::max<std::size_t>(facts.devices.size(), 1));
  return Rows::lineHeightOf(fonts.heading) +
         (4 + 2 + 3 + (facts.slide.empty() ? 0 : 1) + devices) * line + 3 * rule;
}

int paddingOf(const PlateFonts& fonts) { return fonts.text.metrics().em_px * 2 / 3; }

Plate drawStatePlate(const OperatorFacts& facts, const PlateFonts& fonts, const Rect& free) {
  const int padding = paddingOf(fonts);
  Plate plate = makePlate({free.x, free.y, std::min(free.width, 20 * fonts.text.metrics().em_px),
                           std::min(free.height, stateHeight(facts, fonts) + 2 * padding)});
  const Rect all{0, 0, plate.at.width, plate.at.height};
  const Surface surface(plate.rgba, all.width, all.height);
  surface.fillWhole(kGround);
  Rows rows(surface.clippedTo(shrunk(all, padding)), fonts, shrunk(all, padding));
  drawRate(facts, rows);
  drawChart(facts, rows);
  rows.rule();
  drawState(facts, rows);
  rows.rule();
  drawDevices(facts, rows);
  return plate;
}

// Draws messages at the lower edge of `free`, the newest at the bottom: as many as fit below
// `top_px`, 1 to 4. The plate is as wide as the longest message.
Plate drawMessages(const OperatorFacts& facts, const PlateFonts& fonts, const Rect& free,
                   int top_px) {
  const int padding = paddingOf(fonts), line = Rows::lineHeightOf(fonts.text);
  const int room = (free.y + free.height - top_px - 2 * padding) / line;
  const auto count = std::min<std::size_t>(facts.messages.size(),
                                           static_cast<std::size_t>(std::clamp(room, 1, 4)));
  const auto messages = std::span(facts.messages).first(count);
  int longest = 0;
  for (const MessageFact& m : messages) longest = std::max(longest, textWidth(fonts.text, m.text));
  const int width = std::min(free.width, longest + 2 * padding);
  const int height = std::min(free.height, static_cast<int>(count) * line + 2 * padding);
  Plate plate = makePlate({free.x, free.y + free.height - height, width, height});
  const Surface surface(plate.rgba, width, height);
  surface.fillWhole(faded(kGround, messages.front().strength));
  Rect row{padding, height - padding, width - 2 * padding, line};
  for (const MessageFact& m : messages) {
    row.y -= line;
    drawTextIn(surface, fonts.text, row, m.text, faded(kBright, m.strength));
  }
  return plate;
}

}  // namespace

int textSizeFor(int tile_height_px) noexcept { return std::clamp(tile_height_px / 36, 10, 60); }

int headingSizeFor(int tile_height_px) noexcept { return textSizeFor(tile_height_px) * 8 / 5; }

std::vector<Plate> drawPlates(const OperatorFacts& facts, const PlateFonts& fonts,
                              const Rect& tile) {
  std::vector<Plate> plates;
  const Rect free = shrunk(tile, fonts.text.metrics().em_px / 2);
  plates.push_back(drawStatePlate(facts, fonts, free));
  const Rect& state = plates.front().at;
  if (!facts.messages.empty())
    plates.push_back(drawMessages(facts, fonts, free, state.y + state.height));
  return plates;
}

}  // namespace merlin::render::text
