#include "daemon/wall/wall_role.h"

#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "config/drawn_wall.h"
#include "daemon/shm/fields.h"
#include "render/correct/io/mpcdi.h"
#include "render/correct/output_correction.h"
#include "render/frame/correction_chain.h"
#include "render/frame/tile_arrangement.h"
#include "render/out/output_kinds.h"
#include "render/room/presets.h"
#include "render/testcard/card_tiles.h"

namespace merlin::wall {
namespace {

// The models' files with their stamps at the time of reading, so that a file replaced since then is
// noticed.
std::vector<ModelWatch::Watched> filesOf(const std::vector<Model>& models) {
  std::vector<ModelWatch::Watched> files;
  for (const Model& model : models) files.push_back({model.path, model.stamp});
  return files;
}

// Maps the names of a room's tiles to the names of their panels.
std::map<std::string, std::string> panelsOf(const WallSettings& wall) {
  std::map<std::string, std::string> panels;
  for (const render::room::DisplaySettings& display :
       render::room::withPanels(wall.room).displays) {
    if (!display.panel.empty()) panels[display.name] = display.panel;
  }
  return panels;
}

// Returns an output that can be aligned; its `make` builds corrections, which are applied on the
// wall's thread by the threads of `team`. Errors: those of readMeasured().
Result<AlignedOutput> alignedOutput(const render::out::OutputSettings& output,
                                    const render::out::PictureSize& size, ThreadTeam& team) {
  const render::correct::CorrectionSettings& settings = output.correction;
  std::shared_ptr<render::correct::MeasuredCorrection> measured;  // used by `make` and its copies
  if (!settings.mpcdi.empty()) {
    auto read = render::correct::readMeasured(settings.mpcdi, settings.mpcdi_region);
    if (!read) return read.error();
    measured = std::make_shared<render::correct::MeasuredCorrection>(*std::move(read));
  }
  const auto make = [size, measured, &team](const render::correct::CorrectionSettings& wanted) {
    auto map = render::correct::makeCorrectionMap(wanted, size.width, size.height, measured.get(),
                                                  Threads(threadsOr(0)));
    return std::unique_ptr<render::frame::Correction>(
        std::make_unique<render::correct::OutputCorrection>(std::move(map),
                                                            Threads(threadsOr(0), team)));
  };
  return AlignedOutput{output.shownName(), size.width, size.height, settings, make};
}

}  // namespace

Result<std::unique_ptr<WallRole>> WallRole::make(
    const Settings& configured, std::vector<Model> models, std::uint64_t generation,
    const shm::Endpoints& endpoints, state::StateKeeper& keeper, ThreadWatch& watch, Clock& clock) {
  Settings settings = configured;
  settings.wall = drawnWall(configured.wall);
  auto segment = shm::SegmentWriter<shm::WallSegment>::make(
      shm::segmentName(settings.instance, "wall"), shm::wallFields(), generation, clock.now(),
      endpoints);
  if (!segment) return segment.error();
  auto plan = render::tiles::planTiles(settings.wall.tiles);
  if (!plan) return Error{plan.error().code, "/wall/tiles: " + plan.error().what};
  auto scene = render::scene::Scene::make(settings.wall.scene);
  if (!scene) return Error{scene.error().code, "/wall/scene: " + scene.error().what};
  std::unique_ptr<WallRole> role(new WallRole(settings, std::move(models), *std::move(plan),
                                              *std::move(scene), *std::move(segment), keeper, watch,
                                              clock));
  if (const auto made = role->makeOutputs(generation); !made) return made.error();
  if (const auto made = role->makeCorrections(); !made) return made.error();
  role->makeSignals(generation);
  return role;
}

Result<Ok> WallRole::makeOutputs(std::uint64_t generation) {
  const std::string frame_name = shm::segmentName(settings_.instance, "framebuffer");
  // Looked up when they are called: they are set after the outputs are made.
  const render::out::WindowActs window{
      [this](const std::string& name, const std::string& argument) {
        return window_.command(name, argument);
      },
      [this](const std::string& why) { window_.stop(why); }};
  std::vector<render::out::NamedOutput> outputs;
  for (const render::out::OutputSettings& settings : settings_.wall.outputs) {
    auto output =
        render::out::makeOutput(settings, {plan_, frame_name, generation, watch_, clock_,
                                           settings_.wall.tiles, graphics_cards_, window});
    if (!output)
      return Error{output.error().code,
                   fmt::format("output {}: {}", settings.shownName(), output.error().what)};
    outputs.push_back({settings.shownName(), nameOf(settings.kind), *std::move(output)});
    if (settings.kind == render::out::OutputKind::kSharedMemory)
      frame_name.copy(segment_->framebuffer, sizeof segment_->framebuffer - 1);
  }
  outputs_ = render::out::OutputSet(std::move(outputs));
  return Ok{};
}

WallRole::WallRole(const Settings& settings, std::vector<Model> models,
                   render::tiles::TilePlan plan, render::scene::Scene scene,
                   shm::SegmentWriter<shm::WallSegment> segment, state::StateKeeper& keeper,
                   ThreadWatch& watch, Clock& clock)
    : settings_(settings),
      models_(std::move(models)),
      plan_(std::move(plan)),
      scene_(std::move(scene)),
      governor_(settings.wall.governor),
      segment_(std::move(segment)),
      keeper_(keeper),
      watch_(watch),
      clock_(clock),
      graphics_cards_(watch, clock),
      cards_(plan_.frame_width, plan_.frame_height,
             render::testcard::cardTiles(plan_, settings.wall.outputs, panelsOf(settings.wall))),
      model_watch_(filesOf(models_), ShownModels::maker(settings_.wall), watch_, clock_) {}

// Outputs of kind shared_memory receive the frame without correction; all others can be aligned.
Result<Ok> WallRole::makeCorrections() {
  std::vector<AlignedOutput> aligned;
  std::vector<std::string> refused;
  for (std::size_t i = 0; i < settings_.wall.outputs.size(); ++i) {
    const render::out::OutputSettings& output = settings_.wall.outputs[i];
    if (output.kind == render::out::OutputKind::kSharedMemory) {
      refused.push_back(output.shownName());
      corrections_.push_back(nullptr);
      continue;
    }
    auto made =
        alignedOutput(output, *render::out::pictureSize(output, settings_.wall.tiles), team_);
    if (!made)
      return Error{made.error().code,
                   fmt::format("/wall/outputs/{}/correction: {}", i, made.error().what)};
    std::vector<std::unique_ptr<render::frame::Correction>> links;
    if (!output.tiles.empty())
      links.push_back(std::make_unique<render::frame::TileArrangement>(plan_, output.tiles));
    auto correction = std::make_unique<render::frame::ReplaceableCorrection>();
    made->correction = correction.get();
    for (std::size_t corner = 0; corner < made->marks.size(); ++corner)
      made->marks[corner] = render::testcard::cornerOf(plan_, output, corner);
    links.push_back(std::move(correction));
    aligned.push_back(*std::move(made));
    corrections_.push_back(
        links.size() == 1 ? std::move(links.front())
                          : std::make_unique<render::frame::CorrectionChain>(std::move(links)));
  }
  aligner_ =
      std::make_unique<Aligner>(std::move(aligned), std::move(refused), cards_, keeper_, watch_);
  return Ok{};
}

void WallRole::makeSignals(std::uint64_t generation) {
  std::vector<TappedOutput> outputs;
  for (const render::out::OutputSettings& output : settings_.wall.outputs) {
    const render::out::PictureSize size = *render::out::pictureSize(output, settings_.wall.tiles);
    outputs.push_back({output.shownName(), size.width, size.height});
  }
  signals_ =
      std::make_unique<SignalTaps>(settings_.instance, std::move(outputs), generation, clock_);
}

const std::string& WallRole::pathOf(std::size_t content) const {
  return content == 0 ? settings_.wall.model : settings_.wall.contents[content - 1].model;
}

// Returns the index of the content that was shown last, if the configuration still has it, else 0.
std::size_t WallRole::firstContent() {
  const std::string path = keeper_.state().content;
  if (path.empty()) return 0;
  for (std::size_t i = 0; i <= settings_.wall.contents.size(); ++i) {
    if (pathOf(i) == path) return i;
  }
  keeper_.addNotice(
      fmt::format("model {}, which was shown last, is not in the configuration any more: the first "
                  "one is shown",
                  path));
  return 0;
}

// The state stores an empty path for the first content, so that the configuration decides which
// model it is.
void WallRole::tend(Timestamp now) {
  signals_->tend(now);
  const auto shown = segment_->interaction.read();
  if (!shown || kept_content_ == shown->content) return;
  kept_content_ = shown->content;
  const std::string path = shown->content == 0 ? std::string() : pathOf(shown->content);
  if (keeper_.state().content != path) keeper_.change([&](state::State& s) { s.content = path; });
}

WallRole::~WallRole() {
  thread_.stop();
  outputs_ =
      render::out::OutputSet({});  // those of kind window execute commands, which use members
}

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
                  fromSeconds(1 / settings_.wall.governor.rate_hz),
                  settings_.wall.stereo.head.station);
  render::frame::PointerMarker marker(plan_);
  delivery_.emplace(plan_, outputs_, std::vector<render::frame::Overlay*>{&cards_, &marker},
                    std::move(corrections_), signals_.get());
  std::optional<ViewerPlace> viewer = makeViewerPlace();
  render::out::VblankFrameClock frame_clock(clock_, [this] { return outputs_.vblank(); });
  WallLoop loop(
      {models.contents(), scene_, governor_, feed, *delivery_,
       WallSlots{segment_->stats, &segment_->trace, &segment_->interaction, &segment_->outputs},
       clock_, frame_clock, &marker, settings_.wall.render.fade_frames,
       settings_.wall.scene.return_after_s, &progress, &models, viewer ? &*viewer : nullptr,
       on_snapshot_, [this](const AlignInput& input) { aligner_->ask(input); }, firstContent()});
  loop.setRate(keeper_.state().rate_hz);
  loop.calibrate();
  loop_.store(&loop);
  loop.run(stop, [&] { ready_.set_value(models.contexts().renderer()); });
  loop_.store(nullptr);
}

// Returns nullopt if the head is not tracked.
std::optional<ViewerPlace> WallRole::makeViewerPlace() {
  const WallSettings& wall = settings_.wall;
  const render::stereo::HeadSettings& head = wall.stereo.head;
  if (head.station == 0) return std::nullopt;
  const render::tiles::Viewer configured{Eigen::Vector3d::Zero(),
                                         Eigen::Vector3d(wall.tiles.eyes_m.data())};
  return ViewerPlace(render::stereo::Head(head, configured, Eigen::Vector3d(wall.room.eye_m.data()),
                                          wall.scene.still_after_s),
                     head.station, plan_, [this](std::string sentence) {
                       const std::lock_guard lock(viewer_events_mutex_);
                       viewer_events_.push_back(std::move(sentence));
                     });
}

std::vector<std::string> WallRole::viewerEvents() {
  const std::lock_guard lock(viewer_events_mutex_);
  return std::exchange(viewer_events_, {});
}

Result<std::string> WallRole::mend() {
  const auto segment = segment_.mend();
  if (!segment || !segment->empty()) return segment;
  return outputs_.mend();
}

void WallRole::request(WallLoop::Request what) {
  if (WallLoop* loop = loop_.load()) loop->request(what);
}

void WallRole::move(const Eigen::Vector3f& way_radii, const Eigen::Vector3f& turn_deg) {
  constexpr float kRadian = std::numbers::pi_v<float> / 180;
  const auto radius_m = static_cast<float>(settings_.wall.scene.model_radius_m);
  if (WallLoop* loop = loop_.load()) loop->move({way_radii * radius_m, turn_deg * kRadian});
}

void WallRole::hold(std::optional<std::size_t> cost) {
  if (WallLoop* loop = loop_.load()) loop->hold(cost);
}

void WallRole::setRate(std::optional<double> rate_hz) {
  if (WallLoop* loop = loop_.load()) loop->setRate(rate_hz);
}

}  // namespace merlin::wall
