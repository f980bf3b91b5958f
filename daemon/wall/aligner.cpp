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

constexpr auto kAlignerStep = std::chrono::milliseconds(500);
// Pushes of the ball that follow each other within this time are undone as one step.
constexpr Duration kSamePush = std::chrono::milliseconds(500);

// Offsets of the actions align_left to align_down as seen on the wall [px], in the order of
// kAlignActions.
constexpr state::Offset kMoves[] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
constexpr std::size_t kFirstMove = 2, kUndo = 6, kRedo = 7, kNextCard = 8;

Error refusal(const std::string& what) { return {Errc::kInvalidArgument, what}; }

// Returns a description of what a step, or undoing it (`undone`), has changed.
std::string changeText(const state::Step& step, bool undone) {
  if (step.changes.size() > 1) return fmt::format("{} corners or points", step.changes.size());
  const auto& [place, before, after] = step.changes[0];
  const state::Offset& from = undone ? after : before;
  const state::Offset& to = undone ? before : after;
  return fmt::format("{} by {:g}, {:g}", state::nameOf(place), to.x - from.x, to.y - from.y);
}

}  // namespace

bool AlignInput::isNothing() const { return push == state::Offset{} && actions.empty(); }

Aligner::Aligner(std::vector<AlignedOutput> outputs, std::vector<std::string> refused,
                 render::testcard::CardOverlay& cards, state::StateKeeper& keeper,
                 ThreadWatch& watch)
    : cards_(cards),
      keeper_(keeper),
      refused_(std::move(refused)),
      alignment_(keeper.state().alignment),
      set_aside_(keeper.state().set_aside) {
  for (AlignedOutput& output : outputs) entries_.push_back({std::move(output)});
  fitAlignments();
  buildPending();
  thread_ = WatchedThread(watch, "alignment",
                          [this](const std::stop_token& stop, Progress& p) { loop(stop, p); });
}

Aligner::~Aligner() { thread_.stop(); }

// Sets aside the alignments that do not fit their outputs, and brings back those that fit again.
void Aligner::fitAlignments() {
  bool changed = false;
  for (Entry& entry : entries_) {
    const Fitted fitted = fitAlignment(entry.output, alignment_, set_aside_);
    if (!fitted.is_changed) continue;
    changed = true;
    ++entry.wanted;
    const std::string& name = entry.output.name;
    if (!fitted.aside_why.empty()) {
      keeper_.addNotice(fmt::format("the alignment of output {} is set aside: {}; {}", name,
                                    fitted.aside_why, state::kComesBack));
    }
    if (fitted.is_back) {
      keeper_.addNotice(
          fmt::format("the alignment of output {}, which was set aside, is in effect "
                      "again, since the output is as it was then",
                      name));
    }
  }
  if (!changed) return;
  keeper_.change([&](state::State& s) {
    s.alignment = alignment_;
    s.set_aside = set_aside_;
  });
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
  fitAlignments();
  ++entry->wanted;
  wake();
}

Result<Ok> Aligner::move(const state::MoveRequest& request, bool on) {
  const auto entry = find(request.output);
  if (!entry) return entry.error();
  const state::OutputForm form = formOf((*entry)->output);
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
  if (const auto good = checkAlignment((*entry)->output, next); !good) {
    return refusal(fmt::format("{} of output {} stays where it is: {}",
                               state::nameOf(request.place), form.output, good.error().what));
  }
  commit(std::move(next), form.output);
  return Ok{};
}

// Undoes or redoes a step. This is also done if the configuration no longer has the step's output;
// the effect is then visible when the output is configured again.
Result<Ok> Aligner::step(bool undo) {
  Alignment next = alignment_;
  const state::Step* const step = undo ? next.undo() : next.redo();
  if (!step) return refusal(undo ? "there is nothing to undo" : "there is nothing to redo");
  const std::string output = step->output;
  if (const auto entry = find(output); entry) {
    if (const auto good = checkAlignment((*entry)->output, next); !good)
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
    report.outputs.push_back({formOf(entry.output),
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

// Returns the request to move the selected corner by an offset as people in front of the wall see
// it.
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

// Builds the correction of each output whose settings have changed. After several moves in a row,
// only the correction for the last one is built.
void Aligner::buildPending() {
  for (Entry& entry : entries_) {
    render::correct::CorrectionSettings settings;
    std::uint64_t number = 0;
    {
      const std::lock_guard lock(mutex_);
      if (entry.wanted == entry.built) continue;
      number = entry.wanted;
      settings = alignedSettings(entry.output, alignment_);
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
      const bool work = wake_.wait_for(lock, stop, kAlignerStep, [&] { return work_; });
      progress.step();
      if (stop.stop_requested()) return;
      if (!work) continue;
      work_ = false;
      asked = std::exchange(asked_, {});
    }
    executeAsked(asked);
    const Progress::Pause pause(progress);  // building a correction may take seconds
    buildPending();
  }
}

}  // namespace merlin::wall
