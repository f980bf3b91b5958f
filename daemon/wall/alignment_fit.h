// AlignedOutput, an output that can be aligned, and functions that determine whether an alignment
// fits its output. Pure.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/settings.h"
#include "daemon/base/result.h"
#include "daemon/state/alignment.h"
#include "daemon/state/seen_axes.h"
#include "daemon/state/set_aside.h"
#include "render/correct/settings.h"
#include "render/frame/correction.h"
#include "render/frame/replaceable_correction.h"
#include "render/testcard/card_overlay.h"

namespace merlin::wall {

// An output that can be aligned.
struct AlignedOutput {
  std::string name;
  int width = 0, height = 0;                       // size of its image [px]
  render::correct::CorrectionSettings configured;  // the offsets are added to these values
  // Builds a correction from settings that are not off. May take seconds, on all processors.
  std::function<std::unique_ptr<render::frame::Correction>(
      const render::correct::CorrectionSettings&)>
      make;
  // Receives the built corrections; must outlive the aligner.
  render::frame::ReplaceableCorrection* correction = nullptr;
  // Marks of its corners on test cards, in the order of state::kCornerNames.
  std::array<std::optional<render::testcard::MarkedCorner>, 4> marks{};
  std::string fixed{};     // a sentence about why it must not be aligned; empty: it may be
  state::SeenAxes axes{};  // how people see the directions of its signal
};

state::OutputForm formOf(const AlignedOutput& output);

// Returns the configured correction of the output, with its offsets in the alignment added.
render::correct::CorrectionSettings alignedSettings(const AlignedOutput& output,
                                                    const state::Alignment& alignment);

// Checks whether the output can be shown with its offsets in the alignment. Errors:
// kInvalidArgument (the output must not be aligned, or the corrected image would be folded or too
// far outside the output).
Result<Ok> checkAlignment(const AlignedOutput& output, const state::Alignment& alignment);

// Returns why the offsets of this output in the alignment do not fit it: they were made for another
// form of it, or checkAlignment() fails. Empty: they fit, or there are none.
std::string misfitOf(const AlignedOutput& output, const state::Alignment& alignment);

// Returns a sentence about why an output must not be aligned in stereo mode; empty: it may be
// aligned.
std::string fixedOf(const render::out::OutputSettings& output,
                    const render::tiles::TilesSettings& tiles);

// Result of fitAlignment(). If an alignment was set aside and is_back is true, another alignment
// took its place.
struct Fitted {
  bool is_changed = false;  // whether `alignment` or `set_aside` has changed
  std::string aside_why{};  // misfitOf(), if it was set aside; empty: it was not
  bool is_back = false;     // an alignment that was set aside is in effect again
};
// Moves the output's alignment from `alignment` to `set_aside` if it does not fit. If `alignment`
// then has none of this output, moves the newest one that fits from `set_aside` to `alignment`.
Fitted fitAlignment(const AlignedOutput& output, state::Alignment& alignment,
                    state::SetAside& set_aside);

// Returns the outputs whose alignment would be set aside or come back if the wall got the settings
// `drawn`, which are the result of drawnWall().
struct FittedOutput {
  std::string output;
  Fitted fitted;
};
std::vector<FittedOutput> fittedOutputs(const WallSettings& drawn, state::Alignment alignment,
                                        state::SetAside set_aside);

}  // namespace merlin::wall
