// Port: what the wall shows. A model is the first kind; pictures and panoramas are others.
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

namespace merlin::render {

struct GlApi;

// How finely a content can be drawn, and at what cost.
class DetailAxis {
 public:
  virtual ~DetailAxis() = default;

  virtual std::size_t steps() const noexcept = 0;  // at least 1
  // Cost of a step, in units; falls from step 0 on. REQUIRES: step < steps().
  virtual std::size_t costOf(std::size_t step) const noexcept = 0;
  // The finest step that costs at most `budget`; the coarsest where none does.
  virtual std::size_t stepWithin(std::size_t budget) const noexcept = 0;
  // Below this cost nothing is shown that helps a person.
  virtual std::size_t leastUseful() const noexcept = 0;
  virtual std::string_view unit() const noexcept = 0;  // in the plural: "triangles"

  std::size_t fullCost() const noexcept { return costOf(0); }
};

// How a person moves in a content.
enum class Navigation {
  kObject,    // turned and carried about, or walked around: a model
  kPlane,     // moved in its plane, and zoomed: a picture
  kPanorama,  // looked around in from its middle, and zoomed
};

struct ContentBounds {
  float radius_m = 1;             // of its bounding sphere about the origin
  Eigen::Matrix4f T_content_box;  // takes the cube -1..1 to its box, in its coordinates
};

// One tile's view of the content.
struct ContentView {
  std::size_t tile = 0;              // number in the tile plan
  Eigen::Matrix4f clip_from_metres;  // content coordinates in metres to OpenGL's clip space, y up
  Eigen::Matrix3f eye_from_content;  // rotation only: the light stands at the eye
  int width_px = 0;
  float weight = 1;  // of an error in this view, beside the others'
};

// How far one view of a frame has been drawn. What the numbers count is the content's business.
struct DrawProgress {
  std::size_t part = 0, done = 0;
};

// A content's half in one OpenGL context. Thread-bound to the context, which outlives it.
class ContentRenderer {
 public:
  virtual ~ContentRenderer() = default;

  // Once a frame, before its views are drawn: uploads what Content::choose() chose.
  // REQUIRES: nothing of the frame before is still being drawn.
  virtual void beginFrame() = 0;

  // Clears the bound render target's upper left width x height pixels and sets up a tile's view,
  // one of those that choose() was given. y points downwards in the target.
  virtual void beginView(std::size_t tile, int width, int height) = 0;

  // Draws the next slice of that view, a few milliseconds of work. True when the view is whole.
  virtual bool drawSlice(std::size_t tile, DrawProgress& progress) = 0;
};

// Thread-bound to the wall's thread, but for attach().
class Content {
 public:
  virtual ~Content() = default;

  virtual const DetailAxis& detail() const noexcept = 0;
  virtual ContentBounds bounds() const noexcept = 0;
  virtual Navigation navigation() const noexcept = 0;

  // Chooses what a frame shows at `step` of these views. It stays so, and the renderers may read it
  // on their threads, until the next call. REQUIRES: step < detail().steps().
  virtual void choose(std::size_t step, std::span<const ContentView> views) = 0;

  // On a context's thread, at the same time as on others': its half there. The content outlives it.
  // Errors: kUnsupported (a shader, or not enough memory on the GPU), with what GL said.
  virtual Result<std::unique_ptr<ContentRenderer>> attach(const GlApi& gl) const = 0;

  // After every attach(): what was kept for it alone may go.
  virtual void attached() noexcept {}
};

}  // namespace merlin::render
