#include "daemon/wall/wall_role.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "config/drawn_wall.h"
#include "daemon/base/log.h"
#include "daemon/base/printable_text.h"
#include "daemon/base/radian.h"
#include "daemon/shm/fields.h"
#include "render/room/presets.h"
#include "render/testcard/card_tiles.h"

namespace merlin::wall {
namespace {

// Returns the files of the contents with their stamps at the time of reading, so that ModelWatch
// notices a file that was replaced since then. One more place follows, for a file that is not in
// the configuration.
std::vector<ModelWatch::Watched> filesOf(const std::vector<WallContent>& contents) {
  std::vector<ModelWatch::Watched> files;
  for (const WallContent& content : contents)
    files.push_back({content.file, content.stamp, content.isModel() ? "model" : "picture",
                     content.fault, content.left_out});
  files.push_back({});
  return files;
}

std::vector<ContentEntry> entriesOf(const std::vector<WallContent>& contents) {
  std::vector<ContentEntry> entries;
  for (const WallContent& content : contents) entries.push_back(content.entry);
  return entries;
}

std::vector<std::string> faultsOf(const std::vector<WallContent>& contents) {
  std::vector<std::string> faults;
  for (const WallContent& content : contents) faults.push_back(content.fault);
  return faults;
}

// Returns the names of the panels of a room's tiles, by the name of the tile.
std::map<std::string, std::string> panelsOf(const WallSettings& wall) {
  std::map<std::string, std::string> panels;
  for (const render::room::DisplaySettings& display :
       render::room::withPanels(wall.room).displays) {
    if (!display.panel.empty()) panels[display.name] = display.panel;
  }
  return panels;
}

}  // namespace

Result<std::unique_ptr<WallRole>> WallRole::make(const Settings& configured,
                                                 std::vector<WallContent> contents,
                                                 std::uint64_t generation,
                                                 const shm::Endpoints& endpoints,
                                                 state::StateKeeper& keeper, KeptFiles& kept_files,
                                                 ThreadWatch& watch, Clock& clock) {
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
  std::unique_ptr<WallRole> role(new WallRole(settings, std::move(contents), *std::move(plan),
                                              *std::move(scene), *std::move(segment), keeper, watch,
                                              clock));
  auto outputs =
      CorrectedOutputs::make({role->settings_, role->plan_, generation, role->cards_, keeper,
                              kept_files, watch, clock, role->operator_tile_.panelInFrame()});
  if (!outputs) return outputs.error();
  role->outputs_ = *std::move(outputs);
  const std::string frame = sharedFrameName(role->settings_);
  frame.copy(role->segment_->framebuffer, sizeof role->segment_->framebuffer - 1);
  role->requests_.makeFolder();
  return role;
}

WallRole::WallRole(const Settings& settings, std::vector<WallContent> contents,
                   render::tiles::TilePlan plan, render::scene::Scene scene,
                   shm::SegmentWriter<shm::WallSegment> segment, state::StateKeeper& keeper,
                   ThreadWatch& watch, Clock& clock)
    : settings_(settings),
      contents_(std::move(contents)),
      entries_(entriesOf(contents_)),
      missing_(faultsOf(contents_)),
      plan_(std::move(plan)),
      scene_(std::move(scene)),
      governor_(settings.wall.governor),
      segment_(std::move(segment)),
      keeper_(keeper),
      watch_(watch),
      clock_(clock),
      last_content_(entries_, missing_, keeper),
      cards_(plan_.frame_width, plan_.frame_height,
             render::testcard::cardTiles(plan_, settings.wall.outputs, panelsOf(settings.wall))),
      attendance_(settings.wall.playlist),
      operator_tile_(
          {plan_, settings_, entries_, missing_, *segment_, board_, attendance_, clock_}),
      notice_(plan_, segment_->notice, clock_),
      model_watch_(filesOf(contents_), ShownModels::maker(entries_, settings_.wall), missing_,
                   watch_, clock_),
      tiles_(watch_, clock_),
      requests_({settings_.wall, entries_, missing_, model_watch_, attendance_, loop_}) {}

// Returns the number that WallInteraction::content has for the first content: 0 if this is
// /wall/model, otherwise 1, since 0 always stands for /wall/model.
std::uint32_t WallRole::firstNumber() const noexcept {
  return entries_.front().pointer == "/wall/model" ? 0 : 1;
}

// Shows a notice while no content of the configuration can be read, since only the background is
// visible then; but not while a file that is not in the configuration is shown.
void WallRole::tellIfEmpty(Timestamp now) {
  const std::vector<std::string> faults = missing_.faults();
  const bool is_empty = std::ranges::none_of(faults, &std::string::empty);
  if (std::exchange(told_empty_, is_empty) && !is_empty) (void)notice_.show("off");
  const auto shown = segment_->interaction.read();
  if (!is_empty || (shown && shown->content >= firstNumber() + entries_.size())) return;
  // The folder is omitted, since a tile has room for about fifty letters only.
  const std::string& path = entries_.front().path;
  std::string_view reason = faults.front();
  if (reason.starts_with(path + ": ")) reason.remove_prefix(path.size() + 2);
  const std::string why =
      fmt::format("{}: {}; shown once it can be read",
                  oneLine(std::filesystem::path(path).filename().string()), oneLine(reason));
  (void)notice_.stand(
      std::string(wholeCharacters(std::string_view(why).substr(0, Notice::kMostBytes))), now);
}

// Logs when signals are first drawn directly into the memory of displays, and the reason if this is
// not possible.
void WallRole::tellScanOut() {
  const ScanOutReport now = outputs_->scanOut();
  if (now.drawn && !told_scan_out_.drawn)
    logInfo("signals are drawn into the memory that their displays show");
  if (now.fault != told_scan_out_.fault && !now.fault.empty())
    logInfo("signals are read back and copied to a display: {}", now.fault);
  told_scan_out_ = {now.drawn || told_scan_out_.drawn, now.fault};
}

void WallRole::tend(Timestamp now) {
  outputs_->signals().tend(now);
  tellIfEmpty(now);
  tellScanOut();
  notice_.tend(now);
  if (outputs_->aligner().showsCard()) attendance_.attend();
  const auto shown = segment_->interaction.read();
  if (shown) last_content_.keep(shown->content - firstNumber());
}

WallRole::~WallRole() {
  thread_.stop();
  if (outputs_) outputs_->close();
}

std::future<Result<std::string>> WallRole::start() {
  auto ready = ready_.get_future();
  thread_ = WatchedThread(watch_, "wall", [this](const std::stop_token& stop, Progress& progress) {
    run(stop, progress);
  });
  return ready;
}

void WallRole::run(const std::stop_token& stop, Progress& progress) {
  auto made = ShownModels::make(std::move(contents_),
                                {plan_, settings_.wall, model_watch_, missing_, tiles_, clock_},
                                scene_.view().T_eye_model);
  if (!made) {
    ready_.set_value(made.error());
    return;
  }
  ShownModels& models = **made;
  beginCorrecting(models.contexts());
  DeviceFeed feed(shm::segmentName(settings_.instance, "devices"), feedSettings(settings_));
  render::frame::PointerMarker marker(plan_);
  render::out::OutputSet& outputs = outputs_->set();
  delivery_.emplace(plan_, outputs, overlaysWith(marker), outputs_->takeCorrections(),
                    &outputs_->signals());
  std::optional<ViewerPlace> viewer = makeViewerPlace();
  render::out::VblankFrameClock frame_clock(clock_, [&outputs] { return outputs.vblank(); });
  const WallSlots slots{segment_->stats,    &segment_->trace,   &segment_->interaction,
                        &segment_->outputs, &segment_->content, &segment_->idle};
  WallParts parts{models.contents(), scene_,     governor_, feed, *delivery_, slots, clock_,
                  frame_clock,       attendance_};
  parts.marker = &marker;
  parts.progress = &progress;
  parts.replacements = &models;
  parts.viewer = viewer ? &*viewer : nullptr;
  parts.listed = models.listed();
  addOwn(parts);
  WallLoop loop(std::move(parts));
  loop.setRate(keeper_.state().rate_hz);
  loop.calibrate();
  loop_.store(&loop);
  outputs_->startChecks();
  loop.run(stop, [&] { ready_.set_value(models.contexts().renderer()); });
  loop_.store(nullptr);
  outputs_->shaderPass().end();
}

FeedSettings WallRole::feedSettings(const Settings& settings) {
  FeedSettings feed;
  for (const HandSettings& hand : settings.devices.hands) {
    feed.hands.push_back(
        {hand.name, hand.person, hand.glove, {hand.tracker, hand.station}, hand.buttons});
  }
  for (const DeviceSettings& device : settings.devices.list)
    feed.devices.push_back({device.name, device.person});
  const render::stereo::HeadSettings& head = settings.wall.stereo.head;
  feed.head = {head.tracker, head.station};
  feed.stale_after = fromSeconds(settings.devices.stale_after_s);
  feed.turn = fromSeconds(settings.devices.turn_s);
  return feed;
}

void WallRole::reload(const Settings& settings, const WallChanges& changes) {
  WallTuning tuning;
  if (changes.rate) tuning.governor = settings.wall.governor;
  if (changes.playlist) {
    tuning.playlist = settings.wall.playlist;
    tuning.places = placesOf(entries_, settings.wall.playlist.contents);
  }
  if (changes.scene) tuning.scene = settings.wall.scene;
  if (changes.input) tuning.feed = feedSettings(settings);
  if (WallLoop* loop = loop_.load()) loop->tune(std::move(tuning));
  if (!changes.corrections) return;
  for (const render::out::OutputSettings& output : settings.wall.outputs)
    outputs_->aligner().configure(output.shownName(), output.correction);
}

// Returns the overlays in drawing order. A test card covers the plates of the operator's tile; the
// notice and the panel are drawn over the card, since they are useful there too.
std::vector<render::frame::Overlay*> WallRole::overlaysWith(render::frame::PointerMarker& marker) {
  std::vector<render::frame::Overlay*> overlays = {
      operator_tile_.makePlates(),       &cards_, &notice_.overlay(),
      operator_tile_.makePanelOverlay(), &marker, &curtain_};
  std::erase(overlays, nullptr);
  return overlays;
}

void WallRole::addOwn(WallParts& parts) {
  parts.curtain = &curtain_;
  parts.panel = operator_tile_.panel();
  parts.fade_frames = settings_.wall.render.fade_frames;
  parts.return_after_s = settings_.wall.scene.return_after_s;
  parts.on_snapshot = on_snapshot_;
  parts.snapshots_written = snapshots_written_;
  parts.on_align = [this](const AlignInput& input) { outputs_->aligner().ask(input); };
  parts.shows_testcard = [this] { return cards_.isShown(); };
  parts.first_content = last_content_.first();
  parts.first_number = firstNumber();
  parts.playlist = placesOf(entries_, settings_.wall.playlist.contents);
}

// Decides where corrections are computed: by a shader on the GPU, or by the CPU if this is set or
// the shader cannot be used.
void WallRole::beginCorrecting(const render::frame::DrawContexts& contexts) {
  using Place = render::frame::CorrectionPlace;
  RendererReport report{contexts.own->info(), contexts.other ? 2 : 1, contexts.asynchronous};
  const Place place = settings_.wall.render.correction;
  if (place == Place::kGpu || (place == Place::kAuto && !report.info.software)) {
    const bool draws = drawsIntoDisplays(settings_.wall.render, report.info);
    const auto begun = outputs_->shaderPass().begin(*contexts.own, draws);
    report.corrects = begun.ok();
    if (!begun) {
      report.correction_fault = begun.error().what;
      logWarning("corrections are computed on the CPU: {}", begun.error().what);
    }
  }
  const std::lock_guard lock(renderer_mutex_);
  renderer_ = std::move(report);
}

std::optional<RendererReport> WallRole::renderer() const {
  const std::lock_guard lock(renderer_mutex_);
  std::optional<RendererReport> report = renderer_;
  if (!report || !report->corrects) return report;
  report->correction_fault = outputs_->shaderPass().fault();
  report->scan_out = outputs_->scanOut();
  return report;
}

// Returns nothing if the viewer's head is not tracked.
std::optional<ViewerPlace> WallRole::makeViewerPlace() {
  const WallSettings& wall = settings_.wall;
  const render::stereo::HeadSettings& head = wall.stereo.head;
  if (head.station == 0) return std::nullopt;
  const render::tiles::Viewer configured{Eigen::Vector3d::Zero(),
                                         Eigen::Vector3d(wall.tiles.eyes_m.data())};
  return ViewerPlace(render::stereo::Head(head, configured, Eigen::Vector3d(wall.room.eye_m.data()),
                                          wall.scene.still_after_s),
                     head.station, plan_, [this](Event event) {
                       const std::lock_guard lock(viewer_events_mutex_);
                       viewer_events_.push_back(std::move(event));
                     });
}

std::vector<Event> WallRole::viewerEvents() {
  const std::lock_guard lock(viewer_events_mutex_);
  return std::exchange(viewer_events_, {});
}

Result<std::string> WallRole::mend() {
  const auto segment = segment_.mend();
  if (!segment || !segment->empty()) return segment;
  return outputs_->set().mend();
}

void WallRole::request(WallLoop::Request what) {
  if (WallLoop* loop = loop_.load()) loop->request(what);
}

std::vector<Event> WallRole::contentEvents() {
  std::vector<Event> events = model_watch_.takeEvents();
  for (std::string& unreadable : tiles_.takeFaults())
    events.push_back(faultEvent(std::move(unreadable)));
  return events;
}

void WallRole::move(const Eigen::Vector3f& way_radii, const Eigen::Vector3f& turn_deg) {
  const auto radius_m = static_cast<float>(settings_.wall.scene.model_radius_m);
  if (WallLoop* loop = loop_.load()) loop->move({way_radii * radius_m, turn_deg * kRadian<float>});
}

void WallRole::hold(std::optional<std::size_t> cost) {
  if (WallLoop* loop = loop_.load()) loop->hold(cost);
}

std::optional<Pace::Limits> WallRole::holdLimits() const {
  const WallLoop* const loop = loop_.load();
  return loop ? std::optional(loop->holdLimits()) : std::nullopt;
}

void WallRole::setRate(std::optional<double> rate_hz) {
  if (WallLoop* loop = loop_.load()) loop->setRate(rate_hz);
}

}  // namespace merlin::wall
