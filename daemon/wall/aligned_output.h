// Makes an AlignedOutput, which the Aligner can align, from a configured output.
#pragma once

#include <string>

#include "daemon/base/thread_team.h"
#include "daemon/wall/aligner.h"
#include "render/correct/gpu/shader_pass.h"
#include "render/out/output_kinds.h"

namespace merlin::wall {

// Returns an output whose `make` builds corrections; these are applied on the wall's thread by
// `pass`, or by the threads of `team`. Both must outlive the result. `size`: size of its signal.
// `parts`: the pictures in its signal. If the measured file cannot be read, the rest of the
// correction is still applied, because one output that looks wrong is better than a dark wall;
// `unreadable` receives the reason.
AlignedOutput alignedOutput(const render::out::OutputSettings& output,
                            const render::out::PictureSize& size,
                            render::correct::SignalParts parts, ThreadTeam& team,
                            render::correct::CorrectionPass& pass, std::string& unreadable);

}  // namespace merlin::wall
