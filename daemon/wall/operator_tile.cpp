#include "daemon/wall/operator_tile.h"

#include <algorithm>
#include <utility>

#include "daemon/base/log.h"

namespace merlin::wall {
namespace {

// Whether a device of this machine has a port, or the devices of another machine are used.
bool expectsDevices(const Settings& settings) {
  const auto hasPort = [](const DeviceSettings& d) { return !d.line.port.empty(); };
  return !settings.wall.input.endpoint.empty() ||
         std::ranges::any_of(settings.devices.list, hasPort);
}

}  // namespace

OperatorTile::OperatorTile(const Parts& parts) : parts_(parts) {
  const Settings& settings = parts_.settings;
  if (!settings.wall.operator_tile.panel) return;
  render::panel::PanelOptions options = panelOptions(settings, parts_.contents);
  auto place = render::panel::placePanel(parts_.plan, options);
  if (!place) return;  // `merlind --check-config` reports the reason
  panel_.emplace(*std::move(place), std::move(options),
                 OperatorPanel::Parts{parts_.segment, parts_.segment.panel,
                                      shm::segmentName(settings.instance, "devices"),
                                      settings.wall.governor.rate_hz,
                                      static_cast<float>(settings.wall.scene.model_radius_m),
                                      parts_.attendance, parts_.missing, parts_.clock});
}

std::optional<PanelPointer::Place> OperatorTile::panelInFrame() const {
  if (!panel_) return std::nullopt;
  const render::panel::Rect at = panel_->place().inFrame();
  return PanelPointer::Place{at.x, at.y, at.width, at.height};
}

render::frame::Overlay* OperatorTile::makePlates() {
  if (!parts_.settings.wall.operator_tile.overlay) return nullptr;
  facts_.emplace(parts_.segment, shm::segmentName(parts_.settings.instance, "devices"),
                 expectsDevices(parts_.settings), parts_.board);
  auto made = render::text::OperatorOverlay::make(parts_.plan, *facts_, parts_.clock);
  if (!made) logWarning("nothing is drawn over the operator's tile: {}", made.error().what);
  if (made) plates_ = *std::move(made);
  return plates_.get();
}

render::frame::Overlay* OperatorTile::makePanelOverlay() {
  if (!panel_) return nullptr;
  auto made =
      render::panel::PanelOverlay::make(parts_.plan, panel_->place(), panel_->options(), *panel_);
  if (!made) logWarning("the operator's panel is not drawn: {}", made.error().what);
  if (made) panel_overlay_ = *std::move(made);
  return panel_overlay_.get();
}

}  // namespace merlin::wall
