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

struct Misfit {
  std::string output, why;
};
// The outputs of a wall whose alignments do not fit them, so that they are set aside when the wall
// gets these settings. `drawn`: drawnWall() of the configured one.
std::vector<Misfit> misfitsOf(const WallSettings& drawn, const state::Alignment& alignment);

}  // namespace merlin::wall
