// Aligner: moves the corners and mesh points of outputs while the wall runs. After each change, the
// aligner's own thread builds a new correction, which replaces the old one between two frames.
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

// Actions that the aligner executes and to which inputs may be bound. AlignInput::actions has
// indexes into this list.
inline constexpr const char* kAlignActions[] = {
    "align_output_next", "align_corner_next", "align_left", "align_right",  "align_up",
    "align_down",        "align_undo",        "align_redo", "next_testcard"};
inline constexpr std::size_t kAlignActionCount = std::size(kAlignActions);

// Requests of bound inputs since the last read of the input.
struct AlignInput {
  std::vector<std::uint8_t> actions;  // indexes into kAlignActions, in the order of their begin
  state::Offset push{};  // motion of the selected corner by the ball, as seen on the wall [px]
  bool isNothing() const;
};

// Thread-safe.
class Aligner {
 public:
  // Builds the correction of each output from its configuration and the offsets in the keeper's
  // state, before it returns. An alignment that does not fit its output is set aside, and one that
  // fits again comes back into effect; a notice of the keeper reports each. `refused`: names of the
  // outputs that are not corrected. `cards`, `keeper` and `watch` must outlive this object.
  Aligner(std::vector<AlignedOutput> outputs, std::vector<std::string> refused,
          render::testcard::CardOverlay& cards, state::StateKeeper& keeper, ThreadWatch& watch);
  ~Aligner();
  Aligner(const Aligner&) = delete;
  Aligner& operator=(const Aligner&) = delete;

  // Executes a request in one of the forms of state::kAlignForms. A change is saved, and is visible
  // some frames later. Returns state::reportText(). Takes some milliseconds if the output has a
  // mesh. Errors: kInvalidArgument (the request is malformed; there is no such output or point;
  // there is nothing to undo or redo; or the corrected image would be folded or too far outside the
  // output); nothing changes then.
  Result<std::string> run(const std::string& argument);

  // Replaces the configured correction of an output; the change is visible some frames later.
  // Alignments are set aside or come back as in the constructor. Nothing happens if the output is
  // not corrected. REQUIRES: `configured` is valid, and its measured file is the same as before.
  void configure(const std::string& output, const render::correct::CorrectionSettings& configured);

  // Shows the test card with this name from one of the next frames on; "off" ends it. If somebody
  // has selected a corner, this corner is marked on the card. Errors: kInvalidArgument (there is no
  // such card).
  Result<Ok> showCard(const std::string& name);

  // Whether a test card is shown.
  bool showsCard() const;

  // Passes requests of bound inputs to the aligner's thread, which executes them in their order;
  // returns at once. At most kMostAsked actions may wait; further ones are dropped. If a request is
  // refused, a notice of the keeper reports the reason. To be called on the wall's thread.
  void ask(const AlignInput& input);
  static constexpr std::size_t kMostAsked = 200;

  // The corner that bound inputs move.
  struct Selection {
    std::string output;  // name of the output; empty: none can be aligned
    state::Place place;
    bool operator==(const Selection&) const = default;
  };
  Selection selection() const;

 private:
  struct Entry {
    AlignedOutput output;
    // Versions of its correction: the newest one requested, and the newest one built.
    std::uint64_t wanted = 1, built = 0;
  };

  Result<Entry*> find(const std::string& name);
  void fitAlignments();
  // REQUIRES for all of the following: mutex_ is locked.
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
  mutable std::mutex mutex_;  // guards all members up to refusal_
  std::vector<Entry> entries_;
  std::vector<std::string> refused_;
  state::Alignment alignment_;
  state::SetAside set_aside_;
  std::size_t selected_ = 0, corner_ = 0;
  bool chosen_ = false;  // whether somebody has selected a corner
  std::optional<render::testcard::Card> card_;
  std::string done_;    // description of the last undo or redo
  Timestamp pushed_{};  // time of the last push by the ball
  // Why the last request of a bound input was refused, so that the same reason is not reported
  // again; empty: it was executed.
  std::string refusal_;
  std::mutex asked_mutex_;
  std::condition_variable_any wake_;  // used with asked_mutex_
  AlignInput asked_;
  bool work_ = false;
  WatchedThread thread_;
};

}  // namespace merlin::wall
