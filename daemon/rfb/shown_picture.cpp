#include "daemon/rfb/shown_picture.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/fixed_text.h"
#include "daemon/rfb/card.h"

namespace merlin::rfb {
namespace {

// Without a new frame for this time the framebuffer is opened again: it may have been removed and
// created again under the same name, which its old mapping does not show.
constexpr Duration kReopen = std::chrono::seconds(1);
// Size of a card before the first frame [px].
constexpr int kCardWidth = 640, kCardHeight = 480;

}  // namespace

ShownPicture::ShownPicture(std::string instance, View view, SharedMemory::From from)
    : instance_(std::move(instance)),
      view_(std::move(view)),
      from_(from),
      wall_(shm::segmentName(instance_, "wall"), from) {
  resize(kCardWidth, kCardHeight);
}

ShownPicture::Change ShownPicture::update(Timestamp now) {
  const auto fresh = readFrame(now);
  if (!fresh) return showCard(fresh.error().what);
  return *fresh ? showFrame() : Change{};
}

// Copies a newer frame than the one shown into frame_; returns false if there is none. Errors: a
// text for the card.
Result<bool> ShownPicture::readFrame(Timestamp now) {
  const shm::WallSegment* const wall = wall_.get(now);
  command_endpoint_.clear();
  if (!wall) {
    reader_.reset();
    return whyNoWall();
  }
  command_endpoint_ = textIn(wall->header.command_endpoint);
  const auto panel = wall->panel.read();
  panel_in_frame_.reset();
  if (panel) panel_in_frame_ = {panel->x, panel->y, panel->width, panel->height};
  const auto opened = openReader(now, wall->header.generation);
  if (!opened) return opened.error();
  const std::uint64_t newest = reader_->newest();
  if (newest == sequence_ || newest == 0) return false;
  if (!reader_->copy(frame_)) return false;  // overwritten while it was copied
  sequence_ = frame_.info.sequence;
  opened_ = now;
  return true;
}

Error ShownPicture::whyNoWall() const {
  const auto opened =
      shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(instance_, "wall"), from_);
  if (!opened && opened.error().code == Errc::kIo) return opened.error();  // no permission
  return {Errc::kNotFound,
          fmt::format("No merlind shows a wall as \"{}\".\nThe picture returns when it runs.",
                      instance_)};
}

Result<Ok> ShownPicture::openReader(Timestamp now, std::uint64_t generation) {
  if (reader_ && reader_->generation() == generation && now - opened_ < kReopen) return Ok{};
  auto opened =
      render::out::SharedFrameReader::open(shm::segmentName(instance_, "framebuffer"), from_);
  const bool stale = opened && opened->generation() != generation;
  if (!opened || stale) {
    reader_.reset();
    return Error{Errc::kNotFound,
                 fmt::format("The merlind \"{}\" puts no frames into shared memory\n{}", instance_,
                             stale ? "The frames that are there are from an earlier run."
                                   : opened.error().what)};
  }
  // A restarted merlind numbers its frames from the beginning again, so its first frames have the
  // numbers of earlier ones.
  if (!reader_ || reader_->generation() != generation) sequence_ = 0;
  reader_.emplace(*std::move(opened));
  opened_ = now;
  return Ok{};
}

bool ShownPicture::resize(int width, int height) {
  if (width == width_ && height == height_) return false;
  width_ = width;
  height_ = height;
  pixels_.assign(
      std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  return true;
}

ShownPicture::Change ShownPicture::showFrame() {
  const auto layout = layoutOf(frame_, view_);
  if (!layout) return showCard(layout.error().what);
  card_.clear();
  findPanel(*layout);
  Change change;
  change.resized = resize(layout->width, layout->height);
  change.changed = copyChanged(frame_, *layout, pixels_);
  return change;
}

void ShownPicture::findPanel(const Layout& layout) {
  panel_.reset();
  if (!panel_in_frame_) return;
  const Rectangle& at = *panel_in_frame_;
  if (at.x < 0 || at.y < 0) return;  // not written by this release
  for (const auto& [from, to_x, to_y] : layout.pieces) {
    const int x = at.x - from.x, y = at.y - from.y;
    const bool shown = x >= 0 && y >= 0 && at.width > 0 && at.height > 0 &&
                       at.width <= from.width - x && at.height <= from.height - y;
    if (shown)
      panel_ = PanelPointer::Place{to_x + x,  to_y + y,      at.width,
                                   at.height, from.x - to_x, from.y - to_y};
  }
}

ShownPicture::Change ShownPicture::showCard(const std::string& text) {
  panel_.reset();
  if (std::exchange(card_, text) == text) return {};
  drawCard(text, pixels_, width_, height_);
  return {false, {{0, 0, width_, height_}}};
}

}  // namespace merlin::rfb
