#include "daemon/wall/wall_role.h"

#include <utility>

#include <fmt/format.h>

#include "daemon/shm/fields.h"
#include "render/frame/tile_arrangement.h"
#include "render/out/output_kinds.h"

namespace merlin::wall {
namespace {

// With the stamps of the files that were read: one that was replaced since is noticed.
std::vector<ModelWatch::Watched> filesOf(const std::vector<Model>& models) {
  std::vector<ModelWatch::Watched> files;
  for (const Model& model : models) files.push_back({model.path, model.stamp});
  return files;
}

}  // namespace

Result<std::unique_ptr<WallRole>> WallRole::make(const Settings& settings,
                                                 std::vector<Model> models,
                                                 std::uint64_t generation,
                                                 const shm::Endpoints& endpoints,
                                                 ThreadWatch& watch, Clock& clock) {
  auto segment = shm::SegmentWriter<shm::WallSegment>::make(
      shm::segmentName(settings.instance, "wall"), shm::wallFields(), generation, clock.now(),
      endpoints);
  if (!segment) return segment.error();
  auto plan = render::planTiles(settings.wall.tiles);
  if (!plan) return Error{plan.error().code, "/wall/tiles: " + plan.error().what};
  auto scene = render::Scene::make(settings.wall.scene);
  if (!scene) return Error{scene.error().code, "/wall/scene: " + scene.error().what};
  std::unique_ptr<WallRole> role(new WallRole(settings, std::move(models), *std::move(plan),
                                              *std::move(scene), *std::move(segment), watch,
                                              clock));
  if (const auto made = role->makeOutputs(generation); !made) return made.error();
  return role;
}

Result<Ok> WallRole::makeOutputs(std::uint64_t generation) {
  const std::string frame_name = shm::segmentName(settings_.instance, "framebuffer");
  std::vector<render::NamedOutput> outputs;
  for (const render::OutputSettings& settings : settings_.wall.outputs) {
    auto output = render::makeOutput(settings, {plan_, frame_name, generation, watch_, clock_});
    if (!output)
      return Error{output.error().code,
                   fmt::format("output {}: {}", settings.shownName(), output.error().what)};
    outputs.push_back({settings.shownName(), nameOf(settings.kind), *std::move(output)});
    if (settings.kind == render::OutputKind::kSharedMemory)
      frame_name.copy(segment_->framebuffer, sizeof segment_->framebuffer - 1);
  }
  outputs_ = render::OutputSet(std::move(outputs));
  return Ok{};
}

WallRole::WallRole(const Settings& settings, std::vector<Model> models, render::TilePlan plan,
                   render::Scene scene, shm::SegmentWriter<shm::WallSegment> segment,
                   ThreadWatch& watch, Clock& clock)
    : settings_(settings),
      models_(std::move(models)),
      plan_(std::move(plan)),
      scene_(std::move(scene)),
      governor_(settings.wall.governor),
      segment_(std::move(segment)),
      watch_(watch),
      clock_(clock),
      model_watch_(filesOf(models_), ShownModels::maker(settings_.wall), watch_, clock_) {}

// By the number of each output; null where it is sent the frame itself.
std::vector<std::unique_ptr<render::Correction>> WallRole::corrections() const {
  std::vector<std::unique_ptr<render::Correction>> all;
  for (const render::OutputSettings& output : settings_.wall.outputs) {
    all.push_back(output.tiles.empty()
                      ? nullptr
                      : std::make_unique<render::TileArrangement>(plan_, output.tiles));
  }
  return all;
}

WallRole::~WallRole() { thread_.stop(); }

std::future<Result<std::string>> WallRole::start() {
  auto ready = ready_.get_future();
  thread_ = WatchedThread(watch_, "wall", [this](const std::stop_token& stop, Progress& progress) {
    run(stop, progress);
  });
  return ready;
}

void WallRole::run(const std::stop_token& stop, Progress& progress) {
  auto made = ShownModels::make(std::move(models_), plan_, settings_.wall, model_watch_,
                                scene_.view().T_eye_model, clock_);
  if (!made) {
    ready_.set_value(made.error());
    return;
  }
  ShownModels& models = **made;
  DeviceFeed feed(shm::segmentName(settings_.instance, "devices"), settings_.devices.hand.station,
                  fromSeconds(settings_.devices.stale_after_s),
                  fromSeconds(1 / settings_.wall.governor.rate_hz));
  render::PointerMarker marker(plan_);
  render::Delivery delivery(plan_, outputs_, {&marker}, corrections());
  render::TimerFrameClock frame_clock(clock_);
  WallLoop loop({models.contents(), scene_, governor_, feed, delivery, segment_->stats, clock_,
                 frame_clock, &segment_->trace, &marker, &segment_->interaction, &segment_->outputs,
                 settings_.wall.render.fade_frames, settings_.wall.scene.return_after_s, &progress,
                 &models, on_snapshot_});
  loop.calibrate();
  loop_.store(&loop);
  loop.run(stop, [&] { ready_.set_value(models.contexts().renderer()); });
  loop_.store(nullptr);
}

Result<std::string> WallRole::mend() {
  const auto segment = segment_.mend();
  if (!segment || !segment->empty()) return segment;
  return outputs_.mend();
}

void WallRole::request(WallLoop::Request what) {
  if (WallLoop* loop = loop_.load()) loop->request(what);
}

void WallRole::hold(std::optional<std::size_t> triangles) {
  if (WallLoop* loop = loop_.load()) loop->hold(triangles);
}

void WallRole::setRate(std::optional<double> rate_hz) {
  if (WallLoop* loop = loop_.load()) loop->setRate(rate_hz);
}

}  // namespace merlin::wall
