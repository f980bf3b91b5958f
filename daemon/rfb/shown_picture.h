// ShownPicture: the view of a wall as a picture that follows the wall's frames, or a card that says
// why there are none. Survives restarts of merlind.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/panel_pointer.h"
#include "daemon/rfb/view.h"
#include "daemon/shm/segment.h"
#include "render/out/shared_frame.h"

namespace merlin::rfb {

// Thread-bound.
class ShownPicture {
 public:
  // `instance`: name of merlind's instance. `from`: owners whose shared memory is accepted.
  ShownPicture(std::string instance, View view, SharedMemory::From from);

  struct Change {
    bool resized = false;  // pixels() has a new size and address, and all pixels have changed
    std::vector<Rectangle> changed;
  };
  // Looks for a newer frame and updates the picture. Never waits. Cost: a copy of the frame if
  // there is a newer one.
  Change update(Timestamp now);

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  // Returns the picture: RGBA, rows from top to bottom.
  std::span<std::uint8_t> pixels() noexcept { return pixels_; }
  // Returns the text of the card; empty while the wall is shown.
  const std::string& card() const noexcept { return card_; }
  // Returns where pixels() shows the operator's panel; nothing while the panel is not visible.
  const std::optional<PanelPointer::Place>& panel() const noexcept { return panel_; }
  // Returns the address at which the wall takes commands; empty while no wall runs.
  const std::string& commandEndpoint() const noexcept { return command_endpoint_; }

 private:
  Result<bool> readFrame(Timestamp now);
  Error whyNoWall() const;
  void findPanel(const Layout& layout);
  Result<Ok> openReader(Timestamp now, std::uint64_t generation);
  bool resize(int width, int height);
  Change showFrame();
  Change showCard(const std::string& text);

  std::string instance_;
  View view_;
  SharedMemory::From from_;
  shm::SegmentFollower<shm::SegmentReader<shm::WallSegment>> wall_;
  std::optional<render::out::SharedFrameReader> reader_;
  Timestamp opened_{};          // when reader_ was opened, or last had a new frame
  std::uint64_t sequence_ = 0;  // number of the frame shown
  render::out::CapturedFrame frame_;
  std::string command_endpoint_, card_;
  std::optional<PanelPointer::Place> panel_;
  std::optional<Rectangle> panel_in_frame_;
  int width_ = 0, height_ = 0;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace merlin::rfb
