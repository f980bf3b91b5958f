// ContentTurns: keeps which content the wall shows, and the drawing cost of each content's initial
// view.
//
// The governor's cost model is learnt from the view that is shown. When it is replaced by another
// content or by the initial view, the governor is told the new cost before the first frame, if that
// cost was measured.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "render/content/content.h"
#include "render/frame/frame_painter.h"
#include "render/governor/governor.h"

namespace merlin::wall {

// A content as the wall's loop sees it: its detail steps, its kind of navigation, and the painter
// that draws it.
struct ShownContent {
  const render::content::DetailAxis* detail;
  render::frame::FramePainter* painter;
  render::content::Navigation navigation = render::content::Navigation::kObject;
};

// Port (an interface): supplies contents that replace others while the wall runs. Implemented by
// ShownModels.
class ContentSource {
 public:
  virtual ~ContentSource() = default;
  struct Replacement {
    std::size_t place;
    ShownContent content;
  };
  // Called between frames. Returns a new content and the place (index) of the one that it replaces,
  // which is not used again; nullopt if there is none. `T_eye_content`: the view in which it will
  // be drawn. May take long while nothing moves.
  virtual std::optional<Replacement> take(bool moving, const Eigen::Isometry3f& T_eye_content) = 0;
};

// Thread-bound to the wall's thread.
class ContentTurns {
 public:
  // `contents`: at least one; the first one is shown first. They and `governor` must outlive this
  // object.
  ContentTurns(std::vector<ShownContent> contents, render::governor::Governor& governor);

  const render::content::DetailAxis& detail() const noexcept { return *shown().detail; }
  render::frame::FramePainter& painter() const noexcept { return *shown().painter; }
  render::content::Navigation navigation() const noexcept { return shown().navigation; }
  std::size_t index() const noexcept { return index_; }
  // Requests for the next content, since the start.
  std::uint32_t requests() const noexcept { return requests_; }

  // Calibrates the governor with about a dozen frames of the first content at different detail, in
  // at most a second. Then draws three frames of each other content to measure its initial view.
  // Afterwards the first content is shown.
  void calibrate(const Eigen::Isometry3f& T_eye_content);

  // Tells the governor the cost of the initial view of the content shown, if it was measured.
  void expectInitialView() const;

  // requestNext() requests the content that is `times` further in the list, cyclically.
  // showRequested() makes the change; it returns true if another content is shown now.
  void requestNext(std::uint32_t times) noexcept { requests_ += times; }
  bool showRequested();

  // Replaces the content of a place; returns true if that is the one shown.
  bool replace(const ContentSource::Replacement& fresh);

  // Sets the size divisor of every content's painter. The costs of initial views are known only for
  // divisor 1, full size.
  void setSizeDivisor(int divisor);

 private:
  const ShownContent& shown() const noexcept { return contents_[index_]; }
  render::frame::DrawTimes draw(std::size_t step, const Eigen::Isometry3f& T_eye_content) const;
  void measureInitialView(const Eigen::Isometry3f& T_eye_content);

  // Measured: drawing detail of `cost` took drawing_s [s]; drawing_s is 0 if it was not measured.
  struct InitialView {
    std::size_t cost = 0;
    double drawing_s = 0;
  };

  std::vector<ShownContent> contents_;
  render::governor::Governor& governor_;
  std::vector<InitialView> initial_;  // by content
  std::size_t index_ = 0;
  std::uint32_t requests_ = 0;
  int size_divisor_ = 1;
};

}  // namespace merlin::wall
