// OperatorTile: makes what is drawn over the operator's tile: plates with the wall's state, and the
// panel. Both are off by default.
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
    const MissingContents& missing;  // which of `contents` are missing
    shm::WallSegment& segment;
    const MessageBoard& board;
    Attendance& attendance;
    const Clock& clock;
  };
  explicit OperatorTile(const Parts& parts);

  // Returns the panel, of which only the thread-safe members may be called; null if there is none.
  OperatorPanel* panel() { return panel_ ? &*panel_ : nullptr; }
  std::optional<PanelPointer::Place> panelInFrame() const;

  // Each makes an overlay and returns it; null if it is switched off or cannot be made (the reason,
  // such as a missing font, is logged). The overlay is destroyed with this object.
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
