// OperatorTile: what is drawn over the operator's tile: plates with the wall's state, and the
// panel; both are off by default.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "daemon/base/panel_pointer.h"
#include "daemon/wall/message_board.h"
#include "daemon/wall/missing_contents.h"
#include "daemon/wall/operator_facts_reader.h"
#include "daemon/wall/operator_panel.h"
#include "render/text/operator_overlay.h"

namespace merlin::wall {

// Thread-bound to the wall's thread, except panel() and panelInFrame(), which are thread-safe.
class OperatorTile {
 public:
  // All must outlive this object.
  struct Parts {
    const render::tiles::TilePlan& plan;
    const Settings& settings;
    const std::vector<ContentEntry>& contents;
    const MissingContents& missing;  // of contents
    shm::WallSegment& segment;
    const MessageBoard& board;
    Attendance& attendance;
    const Clock& clock;
  };
  explicit OperatorTile(const Parts& parts);

  // The panel, for its thread-safe members; null if there is none.
  OperatorPanel* panel() { return panel_ ? &*panel_ : nullptr; }
  std::optional<PanelPointer::Place> panelInFrame() const;

  // Each makes its overlay; null if that is switched off, or if there is no font, which is logged.
  render::frame::Overlay* makePlates();
  render::frame::Overlay* makePanelOverlay();

 private:
  Parts parts_;
  std::optional<OperatorFactsReader> facts_;
  std::unique_ptr<render::text::OperatorOverlay> plates_;
  std::optional<OperatorPanel> panel_;
  std::unique_ptr<render::panel::PanelOverlay> panel_overlay_;
};

}  // namespace merlin::wall
