// ./dev bench frames: a fixed script of frames of each model, as hashes. Equal hashes before and
// after a change of the drawing code mean equal pixels. Not for comparing machines: drivers differ.
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "daemon/wall/picture.h"
#include "daemon/wall/pointer_marker.h"
#include "render/lod/io/mrm_file.h"

namespace merlin::bench {
namespace {

using Eigen::Isometry3f;

constexpr int kPoses = 6;

// FNV-1a, 64 bits.
std::uint64_t hash(std::span<const std::uint8_t> bytes, std::uint64_t h = 0xcbf29ce484222325U) {
  for (const std::uint8_t b : bytes) h = (h ^ b) * 0x100000001b3U;
  return h;
}

// A turn and a walk past the model; the first is the usual start.
Isometry3f pose(int i) {
  Isometry3f T_eye_model(Eigen::Translation3f(0.12F * static_cast<float>(i), 0.05F, -2.5F));
  T_eye_model.rotate(Eigen::AngleAxisf(0.5F * static_cast<float>(i), Eigen::Vector3f::UnitY()));
  return T_eye_model;
}

class Script {
 public:
  Script(const render::Dendrogram& model, const std::string& name,
         const render::RenderSettings& settings)
      : model_(model), name_(name), settings_(settings) {}

  // False where there is no such context on this machine.
  bool run() {
    auto made = wall::Picture::make(model_, plan_, settings_, 1.0, clock_);
    if (!made) {
      fmt::print(stderr, "frames: {}: {}\n", name_, made.error().what);
      return false;
    }
    picture_ = *std::move(made);
    moving(1);
    moving(2);
    picture_->setScale(1);
    refined();
    pointed();
    return true;
  }

 private:
  void print(const std::string& what, std::uint64_t h) const {
    fmt::print("{:<28} {:<7} {} {:<16} {:016x}\n", name_,
               settings_.backend == render::GlBackend::kEgl ? "egl" : "osmesa", settings_.contexts,
               what, h);
  }
  void moving(int divisor) {
    picture_->setScale(divisor);
    std::uint64_t h = hash({});
    for (int i = 0; i < kPoses; ++i) {
      const std::size_t level = model_.levelFor(std::size_t{1000} << i);
      picture_->draw(pose(i), level, Timestamp::max());
      h = hash(picture_->pixels(), h);
    }
    print(divisor == 1 ? "moving" : "half size", h);
  }
  void refined() {
    for (const bool full : {false, true}) {
      if (full)
        picture_->beginRefining(pose(1));
      else
        picture_->beginRefiningTo(pose(1), model_.levelFor(5000));
      while (!picture_->refine(clock_.now() + std::chrono::milliseconds(20))) {
      }
      print(full ? "full detail" : "finer", hash(picture_->pixels()));
    }
  }
  void pointed() {
    wall::PointerMarker marker(plan_);
    marker.draw(picture_->pixels(), Eigen::Vector3f(0.2F, 0.1F, -2.0F));
    print("pointer", hash(picture_->pixels()));
    marker.erase(picture_->pixels());
    print("pointer gone", hash(picture_->pixels()));
  }

  const render::Dendrogram& model_;
  std::string name_;
  render::RenderSettings settings_;
  SystemClock clock_;
  render::TilePlan plan_ = *render::planTiles({});
  std::unique_ptr<wall::Picture> picture_;
};

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: frame_hashes MODEL.mrm...\n");
    return 2;
  }
  for (int i = 1; i < argc; ++i) {
    const std::string path = argv[i];
    const auto model = render::readMrm(path);
    if (!model) {
      fmt::print(stderr, "frames: {}\n", model.error().what);
      return 1;
    }
    const std::string name = path.substr(path.rfind('/') + 1);
    for (const int contexts : {1, 2}) {
      if (!Script(*model, name,
                  {.backend = render::GlBackend::kEgl, .contexts = contexts, .look = {}})
               .run())
        return 1;
    }
    if (!Script(*model, name, {.backend = render::GlBackend::kOsmesa, .contexts = 1, .look = {}})
             .run())
      return 1;
  }
  return 0;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) { return merlin::bench::main(argc, argv); }
