// ContentTurns: stores which content the wall shows, and the measured drawing time of each
// content's initial view.
//
// The governor learns its cost model from the view that is shown. When another content or the
// initial view replaces this view, the governor is told the change of the drawing time before the
// first frame, if it was measured.
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

// A content as WallLoop uses it: its detail steps, its kind of navigation, and the painter that
// draws it.
struct ShownContent {
  const render::content::DetailAxis* detail;
  render::frame::FramePainter* painter;
  render::content::Navigation navigation = render::content::Navigation::kObject;
  // For a plane: the nearest viewing distance, as a multiple of the initial one.
  float nearest = render::content::kNearestPlane;
  std::string name{};          // the name that people see and that `merlin show` takes
  const char* kind = "model";  // "model", "picture", "panorama"
  std::string slide{};         // for slides: the name of the slide that is shown
  bool missing = false;        // its file could not be read yet, so the content is skipped
};

// Port (an interface) that supplies contents which replace others while the wall runs. Implemented
// by ShownModels and by fakes in tests.
class ContentSource {
 public:
  virtual ~ContentSource() = default;
  struct Replacement {
    std::size_t place;
    ShownContent content;
    bool asked_for = false;     // show it now, from its initial view
    std::uint32_t request = 0;  // number of the request (ContentRequests); 0: none
    std::string refused{};      // why there is no content; then `content` is not valid
    // If `refused`: the place is slides, none of which can be shown, so another place follows.
    bool goes_on = false;
  };
  // Returns a new content and the place (index) of the content that it replaces; nullopt if there
  // is none. The replaced content is no longer valid afterwards. To be called between frames.
  // `moving`: something moves. `T_eye_content`: the view in which the content will be drawn. May
  // take long if nothing moves.
  virtual std::optional<Replacement> take(bool moving, const Eigen::Isometry3f& T_eye_content) = 0;
  // Called before the content of a place is drawn for the first time, and again after another one
  // was drawn.
  virtual void prepare(std::size_t place) { static_cast<void>(place); }
  // Requests the next part of a place, i.e. the next slide; returns false if the next place is to
  // be shown instead. If true, take() returns the slide later.
  virtual bool nextWithin(std::size_t place) {
    static_cast<void>(place);
    return false;
  }
  // Requests the previous part of a place, i.e. the previous slide; returns false if the previous
  // place is to be shown instead. If true, take() returns the slide later.
  virtual bool previousWithin(std::size_t place) {
    static_cast<void>(place);
    return false;
  }
};

// Thread-bound to the wall's thread.
class ContentTurns {
 public:
  // `contents`: at least one; the first one that is not missing is shown first. The first `listed`
  // of them form the list, which is shown in turn; 0: all. Their details and painters, `governor`
  // and `source`, which may be null, must outlive this object.
  ContentTurns(std::vector<ShownContent> contents, render::governor::Governor& governor,
               ContentSource* source = nullptr, std::size_t listed = 0);

  const render::content::DetailAxis& detail() const noexcept { return *shown().detail; }
  render::frame::FramePainter& painter() const noexcept { return *shown().painter; }
  render::content::Navigation navigation() const noexcept { return shown().navigation; }
  std::size_t index() const noexcept { return index_; }
  const ShownContent& content() const noexcept { return shown(); }
  float nearest() const noexcept { return shown().nearest; }

  // Calibrates the governor with about a dozen frames of the first content at different detail
  // steps, which takes at most a second. Then draws three frames of each other listed content to
  // measure the time of its initial view. Afterwards the first content is shown again.
  void calibrate(const Eigen::Isometry3f& T_eye_content);

  // Tells the governor how long drawing the initial view of the content shown takes, if this was
  // measured.
  void expectInitialView() const;

  // Requests of a person, which showRequested() executes. requestNext() requests the content
  // `times` places further in the list, requestPrevious() the one `times` places before, both
  // cyclically; each slide counts as a place. A content outside the list counts as standing just
  // after the listed content that was requested last. This and all other requests skip missing
  // contents.
  void requestNext(std::uint32_t times);
  void requestPrevious(std::uint32_t times);
  // Requests the content of a place for a person. Nothing happens if there is no such place, or its
  // content is missing.
  void choose(std::size_t place) noexcept;
  // Requests the next content of the playlist `places`: the one after the place that was requested
  // last, cyclically, or the first one if that place is not in `places`. If the content shown
  // belongs to the playlist (belongsTo()) and has further slides, the next slide is requested
  // instead. Empty `places`: all contents of the list.
  void requestNextOf(std::span<const std::size_t> places);
  // To be called when no slide of `place` can be shown. If `place` is shown and nothing else was
  // requested, requests the next one of `places`, as requestNextOf() does; or the previous content
  // of the list if a person had requested the previous slide. Returns whether another place is
  // requested now.
  bool leave(std::size_t place, std::span<const std::size_t> places);
  // Whether a playlist of these places may continue with the place that was requested last: it is
  // one of them, or a person chose it. Empty `places`: all contents of the list.
  bool belongsTo(std::span<const std::size_t> places) const;
  // Requests the content of a place, not for a person. Nothing happens if there is no such place,
  // or its content is missing.
  void request(std::size_t place) noexcept;
  // Makes the place that was requested last the one shown. Returns true if another content is shown
  // now.
  bool showRequested();
  // Returns the place that was requested last.
  std::size_t asked() const noexcept { return asked_; }

  // Replaces the content of a place; returns true if this is the place shown. If the content
  // requested last was missing, the new one is requested.
  bool replace(const ContentSource::Replacement& fresh);

  // Sets the size divisor of the painter of each content. The measured times of initial views are
  // valid only for divisor 1, i.e. full size.
  void setSizeDivisor(int divisor);

 private:
  const ShownContent& shown() const noexcept { return contents_[index_]; }
  bool isShownNow() const noexcept { return asked_ == index_ && source_; }
  void requestPlaceAfter(std::span<const std::size_t> places);
  void requestPlaceBefore();
  std::size_t firstThere() const noexcept;
  render::frame::DrawTimes draw(std::size_t step, const Eigen::Isometry3f& T_eye_content) const;
  void measureInitialView(const Eigen::Isometry3f& T_eye_content, std::size_t cost);

  // Drawing the initial view with detail of `cost` took drawing_s; 0: it was not measured.
  struct InitialView {
    std::size_t cost = 0;
    double drawing_s = 0;
  };

  std::vector<ShownContent> contents_;
  render::governor::Governor& governor_;
  std::vector<InitialView> initial_;  // indexed by place
  ContentSource* source_;
  std::size_t listed_;   // number of contents in the list
  std::size_t index_;    // place that is shown
  std::size_t asked_;    // place that showRequested() will show
  std::size_t in_turn_;  // place in the list that was requested last
  bool chosen_ = false;  // a person chose asked_
  bool back_ = false;    // the last request was for the previous slide or content
  int size_divisor_ = 1;
};

}  // namespace merlin::wall
