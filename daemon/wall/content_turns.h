// ContentTurns: keeps which content the wall shows, and the drawing cost of each content's initial
// view.
//
// The governor's cost model is learnt from the view that is shown. When it is replaced by another
// content or by the initial view, the governor is told the new cost before the first frame, if that
// cost was measured.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
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
  // For a plane: the nearest viewing distance, as a multiple of the initial one.
  float nearest = render::content::kNearestPlane;
  std::string name{};          // for people, and for `merlin show`
  const char* kind = "model";  // "model", "picture", "panorama"
  std::string slide{};         // for slides: the name of the slide that is shown
  bool missing = false;        // there is nothing to show yet: it is skipped
};

// Port (an interface): supplies contents that replace others while the wall runs. Implemented by
// ShownModels.
class ContentSource {
 public:
  virtual ~ContentSource() = default;
  struct Replacement {
    std::size_t place;
    ShownContent content;
    bool asked_for = false;     // it is to be shown now, from its start view
    std::uint32_t request = 0;  // of WallRole::show(); 0: none
    std::string refused{};      // why there is nothing to show; then `content` is not used
    bool goes_on = false;  // refused because the place has no further part: the next place follows
  };
  // Called between frames. Returns a new content and the place (index) of the one that it replaces,
  // which is not used again; nullopt if there is none. `T_eye_content`: the view in which it will
  // be drawn. May take long while nothing moves.
  virtual std::optional<Replacement> take(bool moving, const Eigen::Isometry3f& T_eye_content) = 0;
  // Called before the content of a place is drawn for the first time, or again after another one.
  virtual void prepare(std::size_t place) { static_cast<void>(place); }
  // Whether another part of a place (for slides: the next slide) follows before the next place;
  // take() then returns it.
  virtual bool nextWithin(std::size_t place) {
    static_cast<void>(place);
    return false;
  }
  // The same backwards: whether an earlier part of the place is to be shown before the previous
  // place.
  virtual bool previousWithin(std::size_t place) {
    static_cast<void>(place);
    return false;
  }
};

// Thread-bound to the wall's thread.
class ContentTurns {
 public:
  // `contents`: at least one; the first one is shown first. The first `listed` of them are shown in
  // turn; 0: all. They, `governor` and `source`, which may be null, must outlive this object.
  ContentTurns(std::vector<ShownContent> contents, render::governor::Governor& governor,
               ContentSource* source = nullptr, std::size_t listed = 0);

  const render::content::DetailAxis& detail() const noexcept { return *shown().detail; }
  render::frame::FramePainter& painter() const noexcept { return *shown().painter; }
  render::content::Navigation navigation() const noexcept { return shown().navigation; }
  std::size_t index() const noexcept { return index_; }
  const ShownContent& content() const noexcept { return shown(); }
  float nearest() const noexcept { return shown().nearest; }

  // Calibrates the governor with about a dozen frames of the first content at different detail, in
  // at most a second. Then draws three frames of each other content to measure its initial view.
  // Afterwards the first content is shown.
  void calibrate(const Eigen::Isometry3f& T_eye_content);

  // Tells the governor the cost of the initial view of the content shown, if it was measured.
  void expectInitialView() const;

  // Requests of a person. requestNext() requests the content `times` places further in the list,
  // cyclically, requestPrevious() the one `times` places before. A content outside the list counts
  // as standing just after the listed content that was requested last. Missing contents are
  // skipped, here and below.
  // showRequested() makes the change; it returns true if another content is shown now.
  void requestNext(std::uint32_t times);
  void requestPrevious(std::uint32_t times);
  // Requests the content of a place. Nothing happens if there is no such place.
  void choose(std::size_t place) noexcept;
  // Requests the playlist's next content: the one after the place that was requested last in
  // `places`, cyclically, or the first one if that place is not among them. Further parts (slides)
  // of the place that is shown come first, if it belongs to the playlist. Empty `places`: all
  // contents of the list.
  void requestNextOf(std::span<const std::size_t> places);
  // To be called when no further part of `place` can be shown: requests the next of `places`, as
  // above, if `place` is shown and nothing else was requested. If a person wanted the previous
  // part, the previous place follows instead. Returns whether `place` is left.
  bool leave(std::size_t place, std::span<const std::size_t> places);
  // Whether a playlist of these places may go on with the one that was asked for last: it is one of
  // them, or a person chose it.
  bool belongsTo(std::span<const std::size_t> places) const;
  // Requests the content of a place that no person chose.
  void request(std::size_t place) noexcept;
  bool showRequested();
  // The place that was asked for last.
  std::size_t asked() const noexcept { return asked_; }

  // Replaces the content of a place; returns true if that is the one shown. It is requested if all
  // were missing so far.
  bool replace(const ContentSource::Replacement& fresh);

  // Sets the size divisor of every content's painter. The costs of initial views are known only for
  // divisor 1, full size.
  void setSizeDivisor(int divisor);

 private:
  const ShownContent& shown() const noexcept { return contents_[index_]; }
  bool isShownNow() const noexcept { return asked_ == index_ && source_; }
  void requestPlaceAfter(std::span<const std::size_t> places);
  void requestPlaceBefore();
  std::size_t firstThere() const noexcept;
  render::frame::DrawTimes draw(std::size_t step, const Eigen::Isometry3f& T_eye_content) const;
  void measureInitialView(const Eigen::Isometry3f& T_eye_content, std::size_t cost);

  // Measured: drawing detail of `cost` took drawing_s [s]; drawing_s is 0 if it was not measured.
  struct InitialView {
    std::size_t cost = 0;
    double drawing_s = 0;
  };

  std::vector<ShownContent> contents_;
  render::governor::Governor& governor_;
  std::vector<InitialView> initial_;  // by content
  ContentSource* source_;
  std::size_t listed_;   // number of contents that are shown in turn
  std::size_t index_;    // shown
  std::size_t asked_;    // to be shown by showRequested()
  std::size_t in_turn_;  // the one of the list that was asked for last
  bool chosen_ = false;  // a person chose asked_
  bool back_ = false;    // the last request for a part of a place was for the previous one
  int size_divisor_ = 1;
};

}  // namespace merlin::wall
