// ModelPainter: pictures of a model without a window, as `merlin mesh` takes them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/cli/arguments.h"
#include "daemon/wall/picture.h"

namespace merlin::cli {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  // RGBA, rows from top to bottom

  // Puts `right` beside it. REQUIRES: of the same height, unless this one is empty.
  void append(const Image& right);
};

// From where and how.
struct View {
  int width = 640, height = 480;  // [px]
  double yaw_deg = 30, pitch_deg = 0;
  std::string backend = "egl";
  render::RenderSettings render;

  void addTo(Command command);  // --yaw, --pitch, --show, --brightness, --backend
  Eigen::Isometry3f T_eye_model() const;
};

// Thread-bound; one at a time, since each has a GL context of its own.
class ModelPainter {
 public:
  // Model and clock are borrowed; the model fills the picture by its box' sphere. Errors:
  // kUnsupported (no GL of that kind). render::prepareSoftwareGl() was called.
  static Result<ModelPainter> make(const render::Dendrogram& model, const View& view,
                                   const Clock& clock);

  Image draw(std::size_t level);

 private:
  explicit ModelPainter(const View& view) : view_(view) {}

  View view_;
  std::unique_ptr<wall::Picture> picture_;
};

}  // namespace merlin::cli
