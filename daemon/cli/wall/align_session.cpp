#include "daemon/cli/wall/align_session.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace merlin::cli {
namespace {

using What = AlignKey::What;

constexpr const char* kCard = "grid";
constexpr double kStep_px = 1, kFineStep_px = 0.1, kFar = 10;

}  // namespace

AlignSession::AlignSession(AlignLink link, std::string output)
    : link_(std::move(link)), first_output_(std::move(output)) {}

AlignSession::~AlignSession() {
  if (card_) static_cast<void>(link_.show_card("off"));
}

Result<Ok> AlignSession::begin() {
  // A request for an output that does not exist returns an error that names the existing outputs.
  const auto answer = link_.ask(first_output_.empty()
                                    ? state::AlignRequest{state::ListRequest{}}
                                    : state::AlignRequest{state::SelectRequest{first_output_, {}}});
  if (!answer) return answer.error();
  if (answer->outputs.empty()) {
    return Error{Errc::kInvalidArgument,
                 "this wall has no output that can be aligned: outputs of kind shared_memory hold "
                 "the frame without correction"};
  }
  answer_ = *answer;
  const auto found = std::ranges::find(answer_.outputs, first_output_, &AlignedPicture::name);
  choose(found == answer_.outputs.end() ? 0
                                        : static_cast<std::size_t>(found - answer_.outputs.begin()),
         0);
  return Ok{};
}

// Sends the request and stores the answer and its message. After a restart, the wall may have fewer
// outputs, so the index of the selected output is limited.
void AlignSession::ask(const state::AlignRequest& request) {
  auto answer = link_.ask(request);
  message_ = answer ? answer->done : answer.error().what;
  if (answer && !answer->outputs.empty()) answer_ = *std::move(answer);
  output_ = std::min(output_, answer_.outputs.size() - 1);
}

void AlignSession::refresh() {
  const std::string kept = message_;
  ask(state::ListRequest{});
  if (message_.empty()) message_ = kept;
}

void AlignSession::choose(std::size_t output, std::size_t corner) {
  output_ = output % answer_.outputs.size();
  corner_ = corner % 4;
  ask(state::SelectRequest{picture().name, place()});
}

void AlignSession::move(const AlignKey& key) {
  const double by = (fine_ ? kFineStep_px : kStep_px) * (key.far ? kFar : 1);
  state::Offset offset;
  if (key.what == What::kLeft) offset.x = -by;
  if (key.what == What::kRight) offset.x = by;
  if (key.what == What::kUp) offset.y = -by;
  if (key.what == What::kDown) offset.y = by;
  ask(state::MoveRequest{picture().name, place(), picture().axes.onSignal(offset)});
}

void AlignSession::toggleCard() {
  const auto shown = link_.show_card(card_ ? "off" : kCard);
  message_ = shown ? std::string() : shown.error().what;
  if (shown) card_ = !card_;
}

bool AlignSession::press(const AlignKey& key) {
  switch (key.what) {
    case What::kLeft:
    case What::kRight:
    case What::kUp:
    case What::kDown: move(key); break;
    case What::kCorner: choose(output_, static_cast<std::size_t>(key.number)); break;
    case What::kNextCorner: choose(output_, corner_ + 1); break;
    case What::kNextOutput: choose(output_ + 1, corner_); break;
    case What::kPreviousOutput: choose(output_ + answer_.outputs.size() - 1, corner_); break;
    case What::kFine: fine_ = !fine_; break;
    case What::kUndo: ask(state::UndoRequest{}); break;
    case What::kRedo: ask(state::RedoRequest{}); break;
    case What::kCard: toggleCard(); break;
    case What::kQuit: return false;
  }
  return true;
}

std::vector<std::string> AlignSession::screen() const {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("Output {} ({} of {}), {} x {} pixels{}", picture().name, output_ + 1,
                              answer_.outputs.size(), picture().width, picture().height,
                              card_ ? ", test card on" : ""));
  lines.emplace_back();
  const state::SeenAxes& axes = picture().axes;
  for (std::size_t i = 0; i < 4; ++i) {
    const AlignedCorner& corner = picture().corners[axes.cornerOnSignal(i)];
    const state::Offset base = axes.seen(corner.configured), moved = axes.seen(corner.moved);
    lines.push_back(fmt::format("{} {} {:<13} {:>+9.1f} {:>+9.1f}   moved {:>+9.1f} {:>+9.1f}",
                                i == corner_ ? ">" : " ", i + 1, state::kCornerNames[i],
                                base.x + moved.x, base.y + moved.y, moved.x, moved.y));
  }
  if (axes != state::SeenAxes{})
    lines.emplace_back("corners and directions are as seen on the wall; the signal is turned");
  lines.emplace_back();
  lines.push_back(fmt::format("step {} px; {} to undo, {} to redo", fine_ ? kFineStep_px : kStep_px,
                              answer_.undo, answer_.redo));
  lines.push_back(message_);
  lines.emplace_back();
  lines.insert(lines.end(), std::begin(kAlignKeyHelp), std::end(kAlignKeyHelp));
  return lines;
}

}  // namespace merlin::cli
