// Port (an interface): a content, i.e. something that the wall shows: a model, a picture, a
// panorama.
//
// A content is drawn at a step of its own detail axis. Step 0 is full detail and the last step is
// the coarsest. Each step has a cost, in the content's own unit (a model: triangles), that the
// governor budgets. Its bounding sphere lies about the origin of its own coordinates, in metres.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include <Eigen/Geometry>

#include "daemon/base/result.h"
#include "render/content/navigation.h"

namespace merlin::render::gl {
struct GlApi;
}

namespace merlin::render::content {

// How finely a content can be drawn, and at what cost.
class DetailAxis {
 public:
  virtual ~DetailAxis() = default;

  virtual std::size_t steps() const noexcept = 0;  // at least 1
  // Returns the cost of a step, in unit(); it falls from step 0 on. REQUIRES: step < steps().
  virtual std::size_t costOf(std::size_t step) const noexcept = 0;
  // Returns the finest step that costs at most `budget`, or the coarsest step if none does.
  virtual std::size_t stepWithin(std::size_t budget) const noexcept = 0;
  // Returns the lowest cost at which the content is still recognisable.
  virtual std::size_t leastUseful() const noexcept = 0;
  virtual std::string_view unit() const noexcept = 0;  // in the plural: "triangles"

  std::size_t fullCost() const noexcept { return costOf(0); }
};

struct ContentBounds {
  float radius_m = 1;             // radius of its bounding sphere about the origin
  Eigen::Matrix4f T_content_box;  // maps the cube -1..1 to its bounding box, in content coordinates
};

// One tile's view of the content.
struct ContentView {
  std::size_t tile = 0;              // the tile's number in the tile plan
  Eigen::Matrix4f clip_from_metres;  // content coordinates in metres to OpenGL's clip space, y up
  Eigen::Matrix3f eye_from_content;  // rotation only: the light stands at the eye
  int width_px = 0;
  int height_px = 0;
  float weight = 1;  // square root of the weight of squared errors in this view
};

// Says whether the last choose() left out parts that are still being loaded.
enum class Pending {
  kNothing,  // nothing was left out
  kLoading,  // parts were left out; they are shown coarser meanwhile
  kArrived,  // parts were left out, and some have arrived since: another choose() shows them
};

// How far one view of a frame has been drawn. The content defines what the numbers count; both are
// 0 at first.
struct DrawProgress {
  std::size_t part = 0, done = 0;
};

// The part of a content that draws it in one OpenGL context. Thread-bound to the context, which
// must outlive it.
class ContentRenderer {
 public:
  virtual ~ContentRenderer() = default;

  // Called once a frame, before its views are drawn: uploads what Content::choose() chose.
  // REQUIRES: drawing of the previous frame has finished.
  virtual void beginFrame() = 0;

  // Clears the upper left width x height pixels of the bound render target and sets up the view of
  // a tile, which must be one of those passed to choose(). y points downwards in the target.
  virtual void beginView(std::size_t tile, int width, int height) = 0;

  // Draws the next slice of that view, a few milliseconds of work. Returns true when the view is
  // complete.
  virtual bool drawSlice(std::size_t tile, DrawProgress& progress) = 0;
};

// Thread-bound to the wall's thread, except attach().
class Content {
 public:
  virtual ~Content() = default;

  virtual const DetailAxis& detail() const noexcept = 0;
  virtual ContentBounds bounds() const noexcept = 0;
  virtual Navigation navigation() const noexcept = 0;

  // Called before choose(), to say whether the scene moves, so that time for the frame is short. A
  // content that takes in large amounts of new data then does so in small portions.
  virtual void setMoving(bool moving) noexcept { static_cast<void>(moving); }

  // Chooses what the next frame draws at `step` for these views. The choice does not change until
  // the next call, so renderers may read it on their threads. REQUIRES: step < detail().steps().
  virtual void choose(std::size_t step, std::span<const ContentView> views) = 0;

  // Returns whether the last choose() left out parts that are still being loaded.
  virtual Pending pending() const noexcept { return Pending::kNothing; }

  // Creates the renderer for one context. Called on that context's thread, possibly at the same
  // time as on others. The content must outlive it. Errors: kUnsupported (a shader does not
  // compile, or not enough GPU memory), with OpenGL's message.
  virtual Result<std::unique_ptr<ContentRenderer>> attach(const gl::GlApi& gl) const = 0;

  // Called after the last attach(): data that was kept only for attach() may be freed.
  virtual void attached() noexcept {}
};

}  // namespace merlin::render::content
