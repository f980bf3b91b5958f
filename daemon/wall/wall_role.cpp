#include "daemon/wall/wall_role.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/drawn_wall.h"
#include "daemon/base/log.h"
#include "daemon/base/printable_text.h"
#include "daemon/shm/fields.h"
#include "daemon/wall/aligned_output.h"
#include "render/frame/correction_chain.h"
#include "render/frame/tile_arrangement.h"
#include "render/out/output_kinds.h"
#include "render/room/presets.h"
#include "render/stereo/eye_tiles.h"
#include "render/testcard/card_tiles.h"

namespace merlin::wall {
namespace {

// The contents' files with their stamps at the time of reading, so that a file replaced since then
// is noticed. There is one more place, for a file that is not in the configuration.
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

std::vector<std::string> pathsOf(const std::vector<ContentEntry>& entries) {
  std::vector<std::string> paths;
  for (const ContentEntry& entry : entries) paths.push_back(entry.path);
  return paths;
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

Error notShownYet() { return {Errc::kBusy, "the wall has not shown its first frame yet"}; }

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
                                              *std::move(scene), *std::move(segment), keeper,
                                              kept_files, watch, clock));
  if (const auto made = role->makeOutputs(generation); !made) return made.error();
  role->makeCorrections();
  role->makeSignals(generation);
  if (const auto made = role->shown_folder_.make(); !made)
    role->model_watch_.report(faultEvent(made.error().what));
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
    auto output = render::out::makeOutput(
        settings, {plan_, frame_name, generation, watch_, clock_, settings_.wall.tiles,
                   graphics_cards_, window, operator_tile_.panelInFrame()});
    if (!output)
      return Error{output.error().code,
                   fmt::format("output {}: {}", settings.shownName(), output.error().what)};
    outputs.push_back({settings.shownName(), nameOf(settings.kind), *std::move(output)});
    if (settings.kind == render::out::OutputKind::kSharedMemory)
      frame_name.copy(segment_->framebuffer, sizeof segment_->framebuffer - 1);
  }
  outputs_ = render::out::OutputSet(std::move(outputs));
  makeChecks();
  graphics_cards_.open();  // before the drawing contexts do
  return Ok{};
}

WallRole::WallRole(const Settings& settings, std::vector<WallContent> contents,
                   render::tiles::TilePlan plan, render::scene::Scene scene,
                   shm::SegmentWriter<shm::WallSegment> segment, state::StateKeeper& keeper,
                   KeptFiles& kept_files, ThreadWatch& watch, Clock& clock)
    : settings_(settings),
      contents_(std::move(contents)),
      entries_(entriesOf(contents_)),
      missing_(faultsOf(contents_)),
      shown_folder_(settings_.wall.shown, pathsOf(entries_)),
      plan_(std::move(plan)),
      scene_(std::move(scene)),
      governor_(settings.wall.governor),
      segment_(std::move(segment)),
      keeper_(keeper),
      watch_(watch),
      clock_(clock),
      graphics_cards_(kept_files, watch, clock),
      cards_(plan_.frame_width, plan_.frame_height,
             render::testcard::cardTiles(plan_, settings.wall.outputs, panelsOf(settings.wall))),
      attendance_(settings.wall.playlist),
      operator_tile_(
          {plan_, settings_, entries_, missing_, *segment_, board_, attendance_, clock_}),
      notice_(plan_, segment_->notice, clock_),
      model_watch_(filesOf(contents_), ShownModels::maker(entries_, settings_.wall), missing_,
                   watch_, clock_),
      tiles_(watch_, clock_) {}

void WallRole::makeChecks() {
  std::vector<render::out::PictureChecks::Checked> checked;
  for (std::size_t i = 0; i < outputs_.size(); ++i)
    checked.push_back({&outputs_.output(i), fromSeconds(settings_.wall.outputs[i].check_s)});
  checks_.emplace(checked, clock_);
  outputs_.checkWith(&*checks_);
}

// Outputs of kind shared_memory receive the frame without correction; all others can be aligned.
void WallRole::makeCorrections() {
  std::vector<AlignedOutput> aligned;
  std::vector<std::string> refused;
  for (std::size_t i = 0; i < settings_.wall.outputs.size(); ++i) {
    const render::out::OutputSettings& output = settings_.wall.outputs[i];
    if (output.kind == render::out::OutputKind::kSharedMemory) {
      refused.push_back(output.shownName());
      corrections_.push_back(nullptr);
      continue;
    }
    const auto parts = render::stereo::signalParts(output, settings_.wall.tiles);
    std::string unreadable;
    AlignedOutput made = alignedOutput(
        output, *render::out::pictureSize(output, settings_.wall.tiles),
        parts.value_or(render::correct::SignalParts{}), team_, shader_pass_, unreadable);
    if (!unreadable.empty())
      uncorrected_ += fmt::format(
          "{}output {} is shown without its measured warp and blend: {}; mend the file and restart "
          "the wall",
          uncorrected_.empty() ? "" : "; ", output.shownName(), unreadable);
    std::vector<std::unique_ptr<render::frame::Correction>> links;
    if (!output.tiles.empty())
      links.push_back(std::make_unique<render::frame::TileArrangement>(plan_, output.tiles));
    auto correction = std::make_unique<render::frame::ReplaceableCorrection>();
    made.correction = correction.get();
    for (std::size_t corner = 0; corner < made.marks.size(); ++corner)
      made.marks[corner] = render::testcard::cornerOf(plan_, output, corner);
    links.push_back(std::move(correction));
    if (!parts) {
      made.fixed =
          "its pictures of both eyes are not the halves of its signal; let it show one tile, or "
          "use stereo mode two_outputs or anaglyph";
    }
    aligned.push_back(std::move(made));
    corrections_.push_back(
        links.size() == 1 ? std::move(links.front())
                          : std::make_unique<render::frame::CorrectionChain>(std::move(links)));
  }
  aligner_ =
      std::make_unique<Aligner>(std::move(aligned), std::move(refused), cards_, keeper_, watch_);
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

// In shared memory 0 is the model and 1 the first of the contents, whether there is a model or not.
std::uint32_t WallRole::firstNumber() const noexcept {
  return entries_.front().pointer == "/wall/model" ? 0 : 1;
}

// Returns the place of the content that was shown last; nothing if the configuration lacks it.
std::optional<std::size_t> WallRole::lastShown() const {
  const std::string path = keeper_.state().content;
  if (path.empty()) return 0;
  const auto found = std::ranges::find(entries_, path, &ContentEntry::path);
  if (found == entries_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - entries_.begin());
}

std::size_t WallRole::firstContent() {
  if (const auto place = lastShown()) return *place;
  keeper_.addNotice(fmt::format(
      "content {}, which was shown last, is not in the configuration any more: the first "
      "one is shown",
      keeper_.state().content));
  return 0;
}

// While no content can be read: only the background is drawn, or a file that somebody shows.
void WallRole::tellIfEmpty(Timestamp now) {
  const std::vector<std::string> faults = missing_.faults();
  const bool is_empty = std::ranges::none_of(faults, &std::string::empty);
  if (std::exchange(told_empty_, is_empty) && !is_empty) (void)notice_.show("off");
  const auto shown = segment_->interaction.read();
  if (!is_empty || (shown && shown->content >= firstNumber() + entries_.size())) return;
  // A tile has room for about fifty letters: the folder is left out.
  const std::string& path = entries_.front().path;
  std::string_view reason = faults.front();
  if (reason.starts_with(path + ": ")) reason.remove_prefix(path.size() + 2);
  const std::string why =
      fmt::format("{}: {}; shown once it can be read",
                  oneLine(std::filesystem::path(path).filename().string()), oneLine(reason));
  (void)notice_.stand(
      std::string(wholeCharacters(std::string_view(why).substr(0, Notice::kMostBytes))), now);
}

// The state stores an empty path for the first content, so that the configuration decides which
// one it is. A file that is not in the configuration is not stored.
void WallRole::tend(Timestamp now) {
  signals_->tend(now);
  tellIfEmpty(now);
  notice_.tend(now);
  if (aligner_->showsCard()) attendance_.attend();
  const auto shown = segment_->interaction.read();
  if (!shown || kept_content_ == shown->content) return;
  const bool first = !std::exchange(kept_content_, shown->content);
  const std::size_t index = shown->content - firstNumber();
  if (index >= entries_.size()) return;
  // Another is shown since its file cannot be read yet; the next start is to show it.
  if (first && !missing_.faultOf(lastShown().value_or(0)).empty()) return;
  const std::string path = index == 0 ? std::string() : entries_[index].path;
  if (keeper_.state().content != path) keeper_.change([&](state::State& s) { s.content = path; });
}

WallRole::~WallRole() {
  thread_.stop();
  checks_.reset();
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
  delivery_.emplace(plan_, outputs_, overlaysWith(marker), std::move(corrections_), signals_.get());
  std::optional<ViewerPlace> viewer = makeViewerPlace();
  render::out::VblankFrameClock frame_clock(clock_, [this] { return outputs_.vblank(); });
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
  checks_->start(watch_);
  loop.run(stop, [&] { ready_.set_value(models.contexts().renderer()); });
  loop_.store(nullptr);
  shader_pass_.end();
}

FeedSettings WallRole::feedSettings(const Settings& settings) {
  FeedSettings feed;
  for (const HandSettings& hand : settings.devices.hands) {
    feed.hands.push_back({hand.name, hand.person, hand.glove, {hand.tracker, hand.station}});
  }
  for (const DeviceSettings& device : settings.devices.list)
    feed.devices.push_back({device.name, device.person});
  const render::stereo::HeadSettings& head = settings.wall.stereo.head;
  feed.head = {head.tracker, head.station};
  feed.stale_after = fromSeconds(settings.devices.stale_after_s);
  feed.ahead = fromSeconds(1 / settings.wall.governor.rate_hz);
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
  if (changes.rate || changes.input) tuning.feed = feedSettings(settings);
  if (WallLoop* loop = loop_.load()) loop->tune(std::move(tuning));
  if (!changes.corrections) return;
  for (const render::out::OutputSettings& output : settings.wall.outputs)
    aligner_->configure(output.shownName(), output.correction);
}

// From the first to the last that is drawn: a test card hides the plates of the operator's tile,
// the notice and the panel are above it, since they are of use there too.
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
  parts.on_align = [this](const AlignInput& input) { aligner_->ask(input); };
  parts.shows_testcard = [this] { return cards_.isShown(); };
  parts.first_content = firstContent();
  parts.first_number = firstNumber();
  parts.playlist = placesOf(entries_, settings_.wall.playlist.contents);
}

// Decides where corrections are computed. What a shader cannot do, the CPU does.
void WallRole::beginCorrecting(const render::frame::DrawContexts& contexts) {
  using Place = render::frame::CorrectionPlace;
  RendererReport report{contexts.own->info(), contexts.other ? 2 : 1, contexts.asynchronous};
  const Place place = settings_.wall.render.correction;
  if (place == Place::kGpu || (place == Place::kAuto && !report.info.software)) {
    const auto begun = shader_pass_.begin(*contexts.own);
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
  if (report && report->corrects) report->correction_fault = shader_pass_.fault();
  return report;
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
  return outputs_.mend();
}

void WallRole::request(WallLoop::Request what) {
  if (WallLoop* loop = loop_.load()) loop->request(what);
}

Result<std::uint32_t> WallRole::show(const std::string& name) {
  WallLoop* const loop = loop_.load();
  if (!loop) return notShownYet();
  const auto named = std::ranges::find(entries_, name, &ContentEntry::name);
  if (named == entries_.end()) {
    for (const NamedFile& shown : shown_folder_.namedFiles()) {
      if (shown.name == name) return showFile(shown.file);
    }
    return noSuchName(name);
  }
  const auto place = static_cast<std::size_t>(named - entries_.begin());
  if (const std::string fault = missing_.faultOf(place); !fault.empty()) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("{} cannot be shown until its file can be read: {}", name, fault)};
  }
  const std::uint32_t number = ++show_requests_;
  loop->show(place);
  loop->finishRequest(number, {});
  return number;
}

Error WallRole::noSuchName(const std::string& name) const {
  const std::vector<std::string> files = namesInFolder();
  return {Errc::kInvalidArgument,
          fmt::format("\"{}\" is not the name of a content; contents are {}{}{}", excerpt(name),
                      namesOf(entries_),
                      files.empty() ? ""
                                    : fmt::format(", and of files that were shown {}",
                                                  fmt::join(files, ", ")),
                      name.find('/') == std::string::npos
                          ? ""
                          : "; merlind opens no path that a client names: `merlin show FILE` puts "
                            "the file into its content folder")};
}

std::vector<std::string> WallRole::namesInFolder() const {
  constexpr std::size_t kMost = 50;  // a status and an error stay short
  std::vector<std::string> names;
  for (NamedFile& file : shown_folder_.namedFiles()) {
    if (names.size() == kMost) break;
    if (std::ranges::find(entries_, file.name, &ContentEntry::name) == entries_.end())
      names.push_back(std::move(file.name));
  }
  return names;
}

std::vector<std::pair<std::string, std::string>> WallRole::missingContents() const {
  std::vector<std::pair<std::string, std::string>> missing;
  const std::vector<std::string> faults = missing_.faults();
  for (std::size_t i = 0; i < faults.size(); ++i) {
    if (!faults[i].empty()) missing.emplace_back(entries_[i].name, faults[i]);
  }
  return missing;
}

Result<std::uint32_t> WallRole::showFile(const std::string& name) {
  if (!loop_.load()) return notShownYet();
  const auto entry = shown_folder_.entryOf(name);
  if (!entry) return entry.error();
  const std::uint32_t number = ++show_requests_;
  if (const auto shown = showEntry(*entry, number); !shown) return shown.error();
  for (std::string& fault : shown_folder_.tidy(name))
    model_watch_.report(faultEvent(std::move(fault)));
  return number;
}

// A model is read on the watch's thread, since that may take long.
Result<Ok> WallRole::showEntry(const ContentEntry& entry, std::uint32_t request) {
  const auto read = [this, entry, request]() -> Result<ReadyModel> {
    std::vector<std::string> skipped;
    auto content = readContent(entry, settings_.wall.render.model.show, {}, skipped);
    for (const std::string& why : skipped) model_watch_.report(faultEvent(why));
    if (!content) return content.error();
    auto ready = prepareContent(entries_.size(), *std::move(content), settings_.wall);
    if (!ready) return ready.error();
    ready->asked_for = true;
    ready->request = request;
    return ready;
  };
  if (entry.kind == ContentKind::kModel) {
    model_watch_.ask(read, request);
    attendance_.touch();
    return Ok{};
  }
  auto ready = read();
  if (!ready) return ready.error();
  attendance_.touch();
  model_watch_.offer(*std::move(ready));
  return Ok{};
}

std::vector<Event> WallRole::contentEvents() {
  std::vector<Event> events = model_watch_.takeEvents();
  for (std::string& unreadable : tiles_.takeFaults())
    events.push_back(faultEvent(std::move(unreadable)));
  return events;
}

void WallRole::move(const Eigen::Vector3f& way_radii, const Eigen::Vector3f& turn_deg) {
  constexpr float kRadian = std::numbers::pi_v<float> / 180;
  const auto radius_m = static_cast<float>(settings_.wall.scene.model_radius_m);
  if (WallLoop* loop = loop_.load()) loop->move({way_radii * radius_m, turn_deg * kRadian});
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
