#include "daemon/wall/aligner.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/base/printable_text.h"

namespace merlin::wall {
namespace {

using state::Alignment;
using state::Place;

constexpr auto kStep = std::chrono::milliseconds(500);
// For undo, pushes of the ball that follow each other within this time are one step.
constexpr Duration kSamePush = std::chrono::milliseconds(500);
// A corner may lie outside the output by at most this share of its width or height, so that the
// image is not lost.
constexpr double kMostOutside = 0.5;

// Moves of the actions align_left to align_down [px], in the order of kAlignActions.
constexpr state::Offset kMoves[] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
constexpr std::size_t kFirstMove = 2, kUndo = 6, kRedo = 7, kNextCard = 8;

Error refusal(const std::string& what) { return {Errc::kInvalidArgument, what}; }

// Describes what a step, or undoing it, changed.
std::string changeText(const state::Step& step, bool undone) {
  if (step.changes.size() > 1) return fmt::format("{} corners or points", step.changes.size());
  const auto& [place, before, after] = step.changes[0];
  const state::Offset& from = undone ? after : before;
  const state::Offset& to = undone ? before : after;
  return fmt::format("{} by {:g}, {:g}", state::nameOf(place), to.x - from.x, to.y - from.y);
}

// Explains why offsets that were made for `aligned` do not fit the present output; empty if they
// fit.
std::string misfit(const state::OutputForm& aligned, const state::OutputForm& now) {
  state::OutputForm same = aligned;
  same.corners = now.corners;
  if (same != now) {
    return fmt::format(
        "it was made for {} x {} pixels and a mesh of {} x {} points, but the output now has "
        "{} x {} pixels and a mesh of {} x {} points",
        aligned.width, aligned.height, aligned.mesh_columns, aligned.mesh_rows, now.width,
        now.height, now.mesh_columns, now.mesh_rows);
  }
  if (!aligned.corners || aligned.corners == now.corners) return {};
  return "its corners in the configuration are not those with which it was aligned";
}

double outside(double place, double size) { return std::max({0.0, -place, place - size}); }

}  // namespace

bool AlignInput::isNothing() const { return push == state::Offset{} && actions.empty(); }

Aligner::Aligner(std::vector<AlignedOutput> outputs, std::vector<std::string> refused,
                 render::testcard::CardOverlay& cards, state::StateKeeper& keeper,
                 ThreadWatch& watch)
    : cards_(cards),
      keeper_(keeper),
      refused_(std::move(refused)),
      alignment_(keeper.state().alignment) {
  for (AlignedOutput& output : outputs) entries_.push_back({std::move(output)});
  dropMisfits();
  buildPending();
  thread_ = WatchedThread(watch, "alignment",
                          [this](const std::stop_token& stop, Progress& p) { loop(stop, p); });
}

Aligner::~Aligner() { thread_.stop(); }

state::OutputForm Aligner::formOf(const Entry& entry) const {
  const AlignedOutput& o = entry.output;
  const render::correct::MeshSettings& mesh = o.configured.mesh;
  return {o.name, o.width, o.height, mesh.columns, mesh.rows, o.configured.corners};
}

// Drops offsets that were made for another configuration and do not fit the present one.
void Aligner::dropMisfits() {
  bool dropped = false;
  for (const Entry& entry : entries_) {
    const std::string& name = entry.output.name;
    const state::OutputAlignment* const saved = alignment_.find(name);
    if (!saved) continue;
    std::string why = misfit(saved->form, formOf(entry));
    if (const auto good = check(entry, alignment_); why.empty() && !good) why = good.error().what;
    if (why.empty()) continue;
    keeper_.addNotice(fmt::format("the alignment of output {} is dropped: {}", name, why));
    alignment_.forget(name);
    dropped = true;
  }
  if (dropped) keeper_.change([&](state::State& s) { s.alignment = alignment_; });
}

render::correct::CorrectionSettings Aligner::settingsOf(const Entry& entry,
                                                        const Alignment& a) const {
  render::correct::CorrectionSettings settings = entry.output.configured;
  const state::OutputAlignment* const of = a.find(entry.output.name);
  if (!of) return settings;
  for (const auto& [place, by] : of->moved) {
    if (place.of == Place::Of::kPin) {
      moveCorner(settings, place.corner(), by.x, by.y);
    } else {
      moveMeshPoint(settings.mesh, place.column, place.row,
                    {by.x / entry.output.width, by.y / entry.output.height});
    }
  }
  return settings;
}

Result<Ok> Aligner::check(const Entry& entry, const Alignment& a) const {
  if (!entry.output.fixed.empty() && a.find(entry.output.name)) return refusal(entry.output.fixed);
  const double width = entry.output.width, height = entry.output.height;
  const render::correct::CorrectionSettings settings = settingsOf(entry, a);
  const auto faults = validate(settings, entry.output.width, entry.output.height);
  if (!faults.empty())
    return refusal(fmt::format("{} {}", faults[0].pointer.substr(1), faults[0].what));
  for (std::size_t i = 0; i < 4; ++i) {
    const Place corner = state::cornerAt(i);
    const double x = corner.column * width + settings.corners[2 * i],
                 y = corner.row * height + settings.corners[2 * i + 1];
    if (a.offset(entry.output.name, corner) == state::Offset{}) continue;  // as configured
    if (outside(x, width) <= kMostOutside * width && outside(y, height) <= kMostOutside * height)
      continue;
    return refusal(
        fmt::format("corner {} would be at ({}, {}), more than half the output's {} x "
                    "{} pixels outside of it",
                    state::nameOf(corner), x, y, width, height));
  }
  return Ok{};
}

Result<Aligner::Entry*> Aligner::find(const std::string& name) {
  std::vector<std::string> names;
  for (Entry& entry : entries_) {
    if (entry.output.name == name) return &entry;
    names.push_back(entry.output.name);
  }
  if (std::ranges::find(refused_, name) != refused_.end()) {
    return refusal(
        fmt::format("output {} cannot be aligned: it is of kind shared_memory, which holds the "
                    "frame without correction",
                    name));
  }
  return refusal(names.empty()
                     ? std::string("this wall has no output that can be aligned: those of kind "
                                   "shared_memory hold the frame without correction")
                     : fmt::format("there is no output \"{}\"; those that can be aligned are {}",
                                   excerpt(name), fmt::join(names, ", ")));
}

void Aligner::commit(Alignment next, const std::string& output) {
  alignment_ = std::move(next);
  keeper_.change([&](state::State& s) { s.alignment = alignment_; });
  for (Entry& entry : entries_) {
    if (entry.output.name == output) ++entry.wanted;
  }
  wake();
}

void Aligner::wake() {
  const std::lock_guard lock(asked_mutex_);
  work_ = true;
  wake_.notify_one();
}

void Aligner::configure(const std::string& output,
                        const render::correct::CorrectionSettings& configured) {
  const std::lock_guard lock(mutex_);
  const auto entry =
      std::ranges::find_if(entries_, [&](const Entry& e) { return e.output.name == output; });
  if (entry == entries_.end() || entry->output.configured == configured) return;
  entry->output.configured = configured;
  dropMisfits();
  ++entry->wanted;
  wake();
}

Result<Ok> Aligner::move(const state::MoveRequest& request, bool on) {
  const auto entry = find(request.output);
  if (!entry) return entry.error();
  const state::OutputForm form = formOf(**entry);
  if (request.place.of == Place::Of::kMesh &&
      (request.place.column >= form.mesh_columns || request.place.row >= form.mesh_rows)) {
    return refusal(form.mesh_columns == 0
                       ? fmt::format("output {} has no mesh", form.output)
                       : fmt::format("output {} has no {}: its mesh has {} columns and {} rows, "
                                     "counted from 0",
                                     form.output, state::nameOf(request.place), form.mesh_columns,
                                     form.mesh_rows));
  }
  Alignment next = alignment_;
  on ? next.moveOn(form, request.place, request.by) : next.move(form, request.place, request.by);
  if (next.moved() > state::kMostMoved) {
    return refusal(
        fmt::format("more than {} points of meshes cannot be moved at run time; put the "
                    "mesh into the configuration",
                    state::kMostMoved));
  }
  if (const auto good = check(**entry, next); !good) {
    return refusal(fmt::format("{} of output {} stays where it is: {}",
                               state::nameOf(request.place), form.output, good.error().what));
  }
  commit(std::move(next), form.output);
  return Ok{};
}

// A step is undone or redone even if the configuration no longer has its output; the effect becomes
// visible when the output is configured again.
Result<Ok> Aligner::step(bool undo) {
  Alignment next = alignment_;
  const state::Step* const step = undo ? next.undo() : next.redo();
  if (!step) return refusal(undo ? "there is nothing to undo" : "there is nothing to redo");
  const std::string output = step->output;
  if (const auto entry = find(output); entry) {
    if (const auto good = check(**entry, next); !good)
      return refusal(fmt::format("output {} stays as it is: {}", output, good.error().what));
  }
  done_ = fmt::format("{} {}", output, changeText(*step, undo));
  commit(std::move(next), output);
  return Ok{};
}

Result<Ok> Aligner::execute(const state::AlignRequest& request) {
  done_.clear();
  if (const auto* move_request = std::get_if<state::MoveRequest>(&request))
    return move(*move_request);
  if (std::holds_alternative<state::UndoRequest>(request)) return step(true);
  if (std::holds_alternative<state::RedoRequest>(request)) return step(false);
  if (const auto* select = std::get_if<state::SelectRequest>(&request)) {
    const auto entry = find(select->output);
    if (!entry) return entry.error();
    choose(static_cast<std::size_t>(*entry - entries_.data()), select->place.corner());
  }
  if (const auto* reset = std::get_if<state::ResetRequest>(&request)) {
    const auto entry = find(reset->output);
    if (!entry) return entry.error();
    Alignment next = alignment_;
    if (next.reset(reset->output)) commit(std::move(next), reset->output);
  }
  return Ok{};
}

std::string Aligner::report() const {
  state::AlignReport report;
  for (const Entry& entry : entries_) {
    const auto& corners = entry.output.configured.corners;
    report.outputs.push_back({formOf(entry),
                              {corners.begin(), corners.end()},
                              entry.wanted != entry.built,
                              entry.output.axes});
  }
  if (!entries_.empty()) report.selected = entries_[selected_].output.name;
  report.selected_place = state::cornerAt(corner_);
  report.done = done_;
  if (card_) report.test_card = render::testcard::kCardNames[static_cast<std::size_t>(*card_)];
  return state::reportText(report, alignment_);
}

Result<std::string> Aligner::run(const std::string& argument) {
  const auto request = state::parseAlignRequest(argument);
  if (!request) return request.error();
  const std::lock_guard lock(mutex_);
  if (const auto executed = execute(*request); !executed) return executed.error();
  return report();
}

Aligner::Selection Aligner::selection() const {
  const std::lock_guard lock(mutex_);
  return {entries_.empty() ? "" : entries_[selected_].output.name, state::cornerAt(corner_)};
}

void Aligner::choose(std::size_t output, std::size_t corner) {
  selected_ = output;
  corner_ = corner;
  chosen_ = true;
  if (card_) redrawCard();
}

void Aligner::redrawCard() {
  const bool marked = chosen_ && !entries_.empty();
  cards_.show(card_, marked ? entries_[selected_].output.marks[corner_] : std::nullopt);
}

Result<Ok> Aligner::showCard(const std::string& name) {
  const auto card = render::testcard::cardNamed(name);
  if (!card && name != "off") {
    return refusal(fmt::format("there is no test card \"{}\"; there are {}, and off", excerpt(name),
                               fmt::join(render::testcard::kCardNames, ", ")));
  }
  const std::lock_guard lock(mutex_);
  card_ = card;
  redrawCard();
  return Ok{};
}

bool Aligner::showsCard() const {
  const std::lock_guard lock(mutex_);
  return card_.has_value();
}

void Aligner::ask(const AlignInput& input) {
  const std::lock_guard lock(asked_mutex_);
  const std::size_t room = kMostAsked - std::min(asked_.actions.size(), kMostAsked);
  asked_.actions.insert(
      asked_.actions.end(), input.actions.begin(),
      input.actions.begin() + static_cast<std::ptrdiff_t>(std::min(room, input.actions.size())));
  asked_.push.x += input.push.x;
  asked_.push.y += input.push.y;
  work_ = true;
  wake_.notify_one();
}

Result<Ok> Aligner::act(std::size_t action) {
  done_.clear();
  if (action == kUndo || action == kRedo) return step(action == kUndo);
  if (action == kNextCard) {
    const std::size_t next = card_ ? static_cast<std::size_t>(*card_) + 1 : 0;
    card_ = next < render::testcard::kCards
                ? std::optional(static_cast<render::testcard::Card>(next))
                : std::nullopt;
    redrawCard();
    return Ok{};
  }
  if (entries_.empty()) return find("").error();
  if (action == 0) choose((selected_ + 1) % entries_.size(), corner_);
  if (action == 1) choose(selected_, (corner_ + 1) % 4);
  if (action < kFirstMove) return Ok{};
  return move(seenMove(kMoves[action - kFirstMove]));
}

// Builds the request to move the selected corner by an offset that is given as seen by people
// before the wall.
state::MoveRequest Aligner::seenMove(const state::Offset& by) const {
  const AlignedOutput& output = entries_[selected_].output;
  return {output.name, state::cornerAt(corner_), output.axes.onSignal(by)};
}

void Aligner::executeAsked(const AlignInput& input) {
  const std::lock_guard lock(mutex_);
  const auto keepRefusal = [&](const Result<Ok>& done) {
    if (done) return refusal_.clear();
    if (std::exchange(refusal_, done.error().what) == done.error().what) return;
    keeper_.addNotice(fmt::format("align: {}", refusal_));
  };
  for (const std::uint8_t action : input.actions) keepRefusal(act(action));
  if (input.push == state::Offset{} || entries_.empty()) return;
  const Timestamp now = SystemClock().now();
  const bool on = now - std::exchange(pushed_, now) < kSamePush;
  keepRefusal(move(seenMove(input.push), on));
}

// Builds the correction of each output with its newest settings; after several moves in a row, only
// the last one is built.
void Aligner::buildPending() {
  for (Entry& entry : entries_) {
    render::correct::CorrectionSettings settings;
    std::uint64_t number = 0;
    {
      const std::lock_guard lock(mutex_);
      if (entry.wanted == entry.built) continue;
      number = entry.wanted;
      settings = settingsOf(entry, alignment_);
    }
    entry.output.correction->replace(settings.isOff() ? nullptr : entry.output.make(settings));
    const std::lock_guard lock(mutex_);
    entry.built = number;
  }
}

void Aligner::loop(const std::stop_token& stop, Progress& progress) {
  giveWay();
  for (;;) {
    AlignInput asked;
    {
      std::unique_lock lock(asked_mutex_);
      const bool work = wake_.wait_for(lock, stop, kStep, [&] { return work_; });
      progress.step();
      if (stop.stop_requested()) return;
      if (!work) continue;
      work_ = false;
      asked = std::exchange(asked_, {});
    }
    executeAsked(asked);
    const Progress::Pause pause(progress);  // building the map of a large output may take seconds
    buildPending();
  }
}

}  // namespace merlin::wall
