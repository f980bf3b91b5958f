// Outputs that can be aligned, and whether an alignment fits its output. Pure.
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
  int width = 0, height = 0;                       // of its image [px]
  render::correct::CorrectionSettings configured;  // base values to which offsets are added
  // Builds a correction; not called for settings that are off. May take seconds, on all processors.
  std::function<std::unique_ptr<render::frame::Correction>(
      const render::correct::CorrectionSettings&)>
      make;
  render::frame::ReplaceableCorrection* correction = nullptr;  // must outlive the aligner
  // Marks of its corners on test cards, in the order of kCornerNames.
  std::array<std::optional<render::testcard::MarkedCorner>, 4> marks{};
  std::string fixed{};     // a sentence: why it may not be aligned; empty: it may
  state::SeenAxes axes{};  // bound inputs move corners as they are seen
};

state::OutputForm formOf(const AlignedOutput& output);

// The output's configured correction, with the offsets of the alignment added.
render::correct::CorrectionSettings alignedSettings(const AlignedOutput& output,
                                                    const state::Alignment& alignment);

// Whether the output can be shown with its offsets in the alignment. Errors: kInvalidArgument (it
// may not be aligned; the corrected image would be folded, or too far outside the output).
Result<Ok> checkAlignment(const AlignedOutput& output, const state::Alignment& alignment);

// Explains why the offsets that the alignment has of this output do not fit it: they were made for
// another form, or checkAlignment() fails. Empty: they fit, or there are none.
std::string misfitOf(const AlignedOutput& output, const state::Alignment& alignment);

// Why an output may not be aligned in stereo: a sentence; empty: it may.
std::string fixedOf(const render::out::OutputSettings& output,
                    const render::tiles::TilesSettings& tiles);

// What became of an output's alignment. If both happened, another one came back in its place.
struct Fitted {
  bool is_changed = false;  // also true if an alignment that was nothing is gone
  std::string aside_why{};  // why it is set aside: see misfitOf(); empty: it is not
  bool is_back = false;     // one that was set aside fits again, and is in effect
};
// Moves the output's alignment to `set_aside` if it does not fit, and the newest one there that
// fits to `alignment` if that has none of this output.
Fitted fitAlignment(const AlignedOutput& output, state::Alignment& alignment,
                    state::SetAside& set_aside);

// What becomes of the alignments of these outputs when the wall gets these settings, in which
// something changes. `drawn`: drawnWall() of the configured one.
struct FittedOutput {
  std::string output;
  Fitted fitted;
};
std::vector<FittedOutput> fittedOutputs(const WallSettings& drawn, state::Alignment alignment,
                                        state::SetAside set_aside);

}  // namespace merlin::wall
