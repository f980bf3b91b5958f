#include "render/panel/panel_layout.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>
#include <variant>

namespace merlin::render::panel {
namespace {

constexpr int kLeastWidth_px = 320, kLeastHeight_px = 240;

// A part of a row: a button, a value, or an empty space, and its width as a share of the row's
// width.
struct Part {
  int share;
  std::variant<std::monostate, ControlId, FieldId> what{};
};
using Row = std::vector<Part>;

// Rows of the same kind have edges that agree.
std::vector<Row> rowsFor(const PanelOptions& options) {
  using C = ControlId;
  std::vector<Row> rows = {
      {{74, C::kModel}, {74, C::kPicture}},
      {{22, C::kPrevious}, {104, FieldId::kContent}, {22, C::kNext}},
      {{22}, {22, C::kUp}, {22}, {8}, {22, C::kNearer}, {8}, {44, C::kMode}},
      {{22, C::kLeft},
       {22, C::kReset},
       {22, C::kRight},
       {8},
       {22, FieldId::kZoom},
       {8},
       {44, C::kSnapshot}},
      {{22}, {22, C::kDown}, {22}, {8}, {22, C::kFarther}, {8}, {44, C::kBall}},
      {{22, C::kRateLess}, {60, FieldId::kRate}, {22, C::kRateMore}, {44, C::kRateAuto}},
      {{22, C::kDetailLess}, {60, FieldId::kDetail}, {22, C::kDetailMore}, {44, C::kDetailAuto}},
      {{74, C::kBlank}, {74, C::kFreeze}},
  };
  if (options.projectors || options.video) {
    Row row = {{options.video ? 52 : 60, FieldId::kProjectors}};
    if (options.projectors) {
      row.push_back({options.video ? 26 : 44, C::kProjectorsOn});
      row.push_back({options.video ? 26 : 44, C::kProjectorsOff});
    }
    if (options.video) {
      row.push_back({22, C::kVideoA});
      row.push_back({22, C::kVideoB});
    }
    rows.push_back(std::move(row));
  }
  if (options.lamp) {
    rows.push_back({{36, FieldId::kLamp},
                    {28, C::kLampOff},
                    {28, C::kLampSlow},
                    {28, C::kLampFast},
                    {28, C::kLampOn}});
  }
  return rows;
}

void addRow(const Row& row, const Rect& space, int gap_px, PanelLayout& layout) {
  int whole = 0, before = 0;
  for (const Part& part : row) whole += part.share;
  if (whole == 0) return;
  const auto edge = [&](int share) { return space.x + (space.width + gap_px) * share / whole; };
  for (const Part& part : row) {
    const int left = edge(before), right = edge(before + part.share) - gap_px;
    before += part.share;
    const Rect at{left, space.y, right - left, space.height};
    if (const auto* const id = std::get_if<ControlId>(&part.what))
      layout.buttons.push_back({*id, at});
    if (const auto* const id = std::get_if<FieldId>(&part.what)) layout.fields.push_back({*id, at});
  }
}

Point middleOf(const Rect& r) { return {r.x + r.width / 2, r.y + r.height / 2}; }

bool contains(const Rect& r, Point p) {
  return p.x >= r.x && p.y >= r.y && p.x < r.x + r.width && p.y < r.y + r.height;
}

}  // namespace

const Button* PanelLayout::find(ControlId id) const noexcept {
  const auto found = std::ranges::find(buttons, id, &Button::id);
  return found == buttons.end() ? nullptr : &*found;
}

std::optional<PanelLayout> layOutPanel(int tile_width_px, int tile_height_px, int em_px,
                                       const PanelOptions& options) {
  if (tile_width_px < kLeastWidth_px || tile_height_px < kLeastHeight_px) return std::nullopt;
  const std::vector<Row> rows = rowsFor(options);
  const auto count = static_cast<int>(rows.size());
  const int margin = em_px / 2, padding = em_px * 2 / 3, gap = std::max(em_px / 4, 2);
  const int notice = em_px * 5 / 4;
  const int room = tile_height_px - 2 * margin - 2 * padding - notice;
  const int row = std::min(2 * em_px, room / count - gap);
  PanelLayout layout;
  layout.at.width = std::min(17 * em_px, tile_width_px - 2 * margin);
  layout.at.height = count * (row + gap) + notice + 2 * padding;
  layout.at.x = tile_width_px - margin - layout.at.width;
  layout.at.y = (tile_height_px - layout.at.height) / 2;
  Rect space{padding, padding, layout.at.width - 2 * padding, row};
  for (const Row& parts : rows) {
    addRow(parts, space, gap, layout);
    space.y += row + gap;
  }
  layout.notice = {space.x, space.y, space.width, notice};
  return layout;
}

const Button* buttonAt(const PanelLayout& layout, Point in_tile) noexcept {
  const Point at{in_tile.x - layout.at.x, in_tile.y - layout.at.y};
  for (const Button& button : layout.buttons) {
    if (contains(button.at, at)) return &button;
  }
  return nullptr;
}

// Returns the next button: sideways in the same row; up or down, the nearest one in the next row.
ControlId neighbourOf(const PanelLayout& layout, ControlId from, int right, int down) noexcept {
  const Button* const start = layout.find(from);
  if (!start) return layout.buttons.empty() ? from : layout.buttons.front().id;
  const Point at = middleOf(start->at);
  std::pair<int, int> least{std::numeric_limits<int>::max(), 0};  // ahead, across
  ControlId nearest = from;
  for (const Button& button : layout.buttons) {
    const Point to = middleOf(button.at);
    const int ahead = (to.x - at.x) * right + (to.y - at.y) * down;
    const int across = std::abs((to.x - at.x) * down) + std::abs((to.y - at.y) * right);
    if (ahead <= 0 || (right != 0 && across > 0)) continue;
    if (std::pair(ahead, across) >= least) continue;
    least = {ahead, across};
    nearest = button.id;
  }
  return nearest;
}

}  // namespace merlin::render::panel
