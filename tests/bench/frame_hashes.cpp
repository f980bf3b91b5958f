// ./dev bench frames: hashes of a fixed sequence of frames of each model. Equal hashes before and
// after a change of the drawing code mean equal pixels. The hashes of different machines cannot be
// compared, since drivers differ.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "render/frame/pointer_marker.h"
#include "render/lod/io/mrm_file.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/support/model_frames.h"

namespace merlin::bench {
namespace {

using Eigen::Isometry3f;

constexpr int kPoses = 6;

// Returns the 64-bit FNV-1a hash of the bytes; `h`: the hash so far.
std::uint64_t hash(std::span<const std::uint8_t> bytes, std::uint64_t h = 0xcbf29ce484222325U) {
  for (const std::uint8_t b : bytes) h = (h ^ b) * 0x100000001b3U;
  return h;
}

// Returns the i-th pose. The poses turn the model and move it past the viewer; the first one is the
// usual start.
Isometry3f pose(int i) {
  Isometry3f T_eye_model(Eigen::Translation3f(0.12F * static_cast<float>(i), 0.05F, -2.5F));
  T_eye_model.rotate(Eigen::AngleAxisf(0.5F * static_cast<float>(i), Eigen::Vector3f::UnitY()));
  return T_eye_model;
}

class Script {
 public:
  Script(const render::lod::Dendrogram& model, const std::string& name,
         const render::frame::RenderSettings& settings, Report& report)
      : model_(model), name_(name), settings_(settings), report_(report) {}

  void run() {
    auto made = test::rendererOf(model_, plan_, settings_, 1.0, clock_);
    if (!made) didNotRun(fmt::format("{} of {}", context(), name_), made.error().what, "see EGL");
    renderer_ = *std::move(made);
    moving(1);
    moving(2);
    renderer_->setSizeDivisor(1);
    refined();
    pointed();
  }

 private:
  std::string context() const {
    return fmt::format("{} {}",
                       settings_.gl.backend == render::gl::GlBackend::kEgl ? "egl" : "osmesa",
                       settings_.gl.contexts);
  }
  // Ends the benchmark if the picture has one colour only, since then the model was not drawn.
  void expectDrawn() const {
    const auto pixels = renderer_->pixels();
    if (std::equal(pixels.begin() + 4, pixels.end(), pixels.begin()))
      didNotRun(fmt::format("{} of {}", context(), name_), "it drew nothing", "see EGL");
  }
  void print(const std::string& what, std::uint64_t h, std::uint64_t frames = 1) {
    const std::string hex = fmt::format("{:016x}", h);
    report_.text("{:<28} {:<9} {:<16} {}\n", name_, context(), what, hex);
    report_.figure(fmt::format("{} {} {}", name_, context(), what), hex, frames);
  }
  void moving(int divisor) {
    renderer_->setSizeDivisor(divisor);
    std::uint64_t h = hash({});
    for (int i = 0; i < kPoses; ++i) {
      const std::size_t level = model_.levelFor(std::size_t{1000} << i);
      renderer_->draw({.T_eye_content = pose(i), .step = level});
      expectDrawn();
      h = hash(renderer_->pixels(), h);
    }
    print(divisor == 1 ? "moving" : "half size", h, kPoses);
  }
  void refined() {
    for (const bool full : {false, true}) {
      renderer_->beginRefining(pose(1), full ? 0 : model_.levelFor(5000));
      while (!renderer_->refine(clock_.now() + std::chrono::milliseconds(20))) {
      }
      print(full ? "full detail" : "finer", hash(renderer_->pixels()));
    }
  }
  void pointed() {
    render::frame::PointerMarker marker(plan_);
    marker.pointAt({Eigen::Vector3f(0.2F, 0.1F, -2.0F)});
    marker.draw(renderer_->pixels());
    print("pointer", hash(renderer_->pixels()));
    marker.erase(renderer_->pixels());
    print("pointer gone", hash(renderer_->pixels()));
  }

  const render::lod::Dendrogram& model_;
  std::string name_;
  render::frame::RenderSettings settings_;
  Report& report_;
  SystemClock clock_;
  render::tiles::TilePlan plan_ = *render::tiles::planTiles({});
  std::unique_ptr<render::frame::FrameRenderer> renderer_;
};

bool run(const std::vector<std::string>& paths, Report& report) {
  for (const std::string& path : paths) {
    const auto model = render::lod::readMrm(path);
    if (!model) didNotRun("the model", model.error().what, "'./dev bench frames' makes the demo's");
    const std::string name = path.substr(path.rfind('/') + 1);
    for (const auto& [backend, contexts] :
         {std::pair{render::gl::GlBackend::kEgl, 1}, std::pair{render::gl::GlBackend::kEgl, 2},
          std::pair{render::gl::GlBackend::kOsmesa, 1}}) {
      Script(*model, name, {.gl = {backend, contexts, 0}, .model = {}}, report).run();
    }
  }
  return true;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  std::vector<std::string> models;
  merlin::bench::CommandLine app("Hashes of a fixed script of frames of each model.");
  app.option("models", models, "Models (.mrm)").required();
  return app.run("frames", argc, argv,
                 [&](merlin::bench::Report& report) { return merlin::bench::run(models, report); });
}
