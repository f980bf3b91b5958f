// Aligner: moves the corners and mesh points of outputs while the wall runs. Each change builds a
// new correction on the aligner's own thread, which replaces the old correction between two frames.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/watched_thread.h"
#include "daemon/state/align_request.h"
#include "daemon/state/state_keeper.h"
#include "daemon/wall/alignment_fit.h"
#include "render/correct/settings.h"
#include "render/testcard/card_overlay.h"

namespace merlin::wall {

// Actions that inputs may be bound to, in this order: align_output_next, align_corner_next,
// align_left, align_right, align_up, align_down, align_undo, align_redo, next_testcard.
inline constexpr const char* kAlignActions[] = {
    "align_output_next", "align_corner_next", "align_left", "align_right",  "align_up",
    "align_down",        "align_undo",        "align_redo", "next_testcard"};
inline constexpr std::size_t kAlignActionCount = std::size(kAlignActions);

// Requests of bound inputs since they were last read.
struct AlignInput {
  std::vector<std::uint8_t> actions;  // indexes into kAlignActions, in the order of their begin
  state::Offset push{};               // motion of the selected corner by the ball [px]
  bool isNothing() const;
};

// Thread-safe.
class Aligner {
 public:
  // On return, the correction of each output is built from its configuration and the offsets of the
  // keeper's state; an alignment that does not fit its output is set aside, and one that fits again
  // comes back, each with a notice.
  // `refused`: names of outputs that are not corrected. `cards`, `keeper` and `watch` must outlive
  // this object.
  Aligner(std::vector<AlignedOutput> outputs, std::vector<std::string> refused,
          render::testcard::CardOverlay& cards, state::StateKeeper& keeper, ThreadWatch& watch);
  ~Aligner();
  Aligner(const Aligner&) = delete;
  Aligner& operator=(const Aligner&) = delete;

  // Executes a request in one of the forms of state::kAlignForms. A change is saved, and shown some
  // frames later. Returns state::reportText(). Takes some milliseconds if the output has a mesh.
  // Errors, which change nothing: kInvalidArgument (no such output or point; the corrected image
  // would be folded, or too far outside the output).
  Result<std::string> run(const std::string& argument);

  // Takes other base values for an output, which are shown some frames later; alignments are set
  // aside or come back as at the start. An output that is not corrected is ignored.
  // REQUIRES: validate(configured); the measured file is the same as before.
  void configure(const std::string& output, const render::correct::CorrectionSettings& configured);

  // Shows the test card of this name from one of the next frames on; "off" shows none. The selected
  // corner is marked on it once somebody has selected one. Errors: kInvalidArgument.
  Result<Ok> showCard(const std::string& name);

  // Whether a test card is shown.
  bool showsCard() const;

  // Passes on requests of bound inputs, which are executed in their order; returns at once. At most
  // kMostAsked actions wait; further ones are dropped. To be called on the wall's thread. A move
  // that is refused is reported as a notice of the keeper.
  void ask(const AlignInput& input);
  static constexpr std::size_t kMostAsked = 200;

  // The corner that the actions move.
  struct Selection {
    std::string output;  // empty: no output can be aligned
    state::Place place;
    bool operator==(const Selection&) const = default;
  };
  Selection selection() const;

 private:
  struct Entry {
    AlignedOutput output;
    std::uint64_t wanted = 1, built = 0;  // versions of its settings: the newest, the one shown
  };

  Result<Entry*> find(const std::string& name);
  void fitAlignments();
  // Each of the following must be called with mutex_ locked.
  Result<Ok> execute(const state::AlignRequest& request);
  Result<Ok> move(const state::MoveRequest& request, bool on = false);
  Result<Ok> step(bool undo);
  Result<Ok> act(std::size_t action);
  state::MoveRequest seenMove(const state::Offset& by) const;
  void commit(state::Alignment next, const std::string& output);
  std::string report() const;
  void choose(std::size_t output, std::size_t corner);
  void redrawCard();

  void wake();
  void loop(const std::stop_token& stop, Progress& progress);
  void executeAsked(const AlignInput& input);
  void buildPending();

  render::testcard::CardOverlay& cards_;
  state::StateKeeper& keeper_;
  mutable std::mutex mutex_;  // protects all members that follow, up to refusal_
  std::vector<Entry> entries_;
  std::vector<std::string> refused_;
  state::Alignment alignment_;
  state::SetAside set_aside_;
  std::size_t selected_ = 0, corner_ = 0;
  bool chosen_ = false;  // somebody has selected a corner
  std::optional<render::testcard::Card> card_;
  std::string done_;     // description of the last undo or redo
  Timestamp pushed_{};   // time of the last push by the ball
  std::string refusal_;  // of a bound input, if its last request was refused; reported only once
  std::mutex asked_mutex_;
  std::condition_variable_any wake_;  // with asked_mutex_
  AlignInput asked_;
  bool work_ = false;
  WatchedThread thread_;
};

}  // namespace merlin::wall
