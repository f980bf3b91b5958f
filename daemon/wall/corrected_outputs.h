// CorrectedOutputs: the outputs of the configuration, each with the correction of its picture, the
// check of what it shows and the tap of its signal; and the alignment of them all.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/settings.h"
#include "daemon/base/clock.h"
#include "daemon/base/kept_files.h"
#include "daemon/base/panel_pointer.h"
#include "daemon/base/thread_team.h"
#include "daemon/base/watched_thread.h"
#include "daemon/state/state_keeper.h"
#include "daemon/wall/aligner.h"
#include "daemon/wall/signal_taps.h"
#include "render/correct/gpu/shader_pass.h"
#include "render/frame/correction.h"
#include "render/frame/settings.h"
#include "render/gl/renderer_info.h"
#include "render/out/kms_output.h"
#include "render/out/output_kinds.h"
#include "render/out/output_set.h"
#include "render/testcard/card_overlay.h"
#include "render/tiles/tile_plan.h"

namespace merlin::wall {

// How signals that the GPU corrects come to the displays.
struct ScanOutReport {
  bool drawn = false;   // at least one output's last signal was drawn into the memory that it shows
  std::string fault{};  // why one is copied that might be drawn; empty: none is
};

// All that is referred to outlives CorrectedOutputs.
struct CorrectedOutputsParts {
  const Settings& settings;  // `wall` is drawnWall() of the configured one
  const render::tiles::TilePlan& plan;
  std::uint64_t generation = 0;  // new at each start of the daemon
  render::testcard::CardOverlay& cards;
  state::StateKeeper& keeper;
  KeptFiles& kept_files;
  ThreadWatch& watch;
  Clock& clock;
  // The operator's panel in the frame; nothing: there is none.
  std::optional<PanelPointer::Place> panel{};
};

// Thread-bound to the wall's thread once that runs, but for aligner(), whose members are
// thread-safe, signals(), uncorrected() and scanOut().
class CorrectedOutputs {
 public:
  // Opens the outputs. If any is of kind kms, this must precede the creation of every drawing
  // context. Errors: those of makeOutput(), with the output's name.
  static Result<std::unique_ptr<CorrectedOutputs>> make(const CorrectedOutputsParts& parts);
  ~CorrectedOutputs() = default;
  CorrectedOutputs(const CorrectedOutputs&) = delete;
  CorrectedOutputs& operator=(const CorrectedOutputs&) = delete;

  // Sets the functions that outputs of kind window call, on their own threads, for the person at
  // them.
  void onWindow(render::out::WindowActs acts) { window_ = std::move(acts); }

  render::out::OutputSet& set() { return outputs_; }
  // Begins to check from time to time what the outputs show.
  void startChecks() { checks_->start(parts_.watch); }
  // Returns the corrections by output number; null if the output is sent the frame itself. To be
  // called once; the caller must keep them until close().
  std::vector<std::unique_ptr<render::frame::Correction>> takeCorrections() {
    return std::move(corrections_);
  }
  render::correct::ShaderPass& shaderPass() { return shader_pass_; }
  // Thread-safe until close().
  ScanOutReport scanOut() const;

  Aligner& aligner() { return *aligner_; }
  SignalTaps& signals() { return *signals_; }
  // Which outputs are shown without the correction that was measured for them, and why; empty:
  // none. The same as long as the wall runs.
  const std::string& uncorrected() const noexcept { return uncorrected_; }

  // Closes all outputs and ends the alignment. Outputs of kind window execute commands until then,
  // so this must be called before anything that those commands use is destroyed.
  void close();

 private:
  explicit CorrectedOutputs(const CorrectedOutputsParts& parts);
  Result<Ok> makeOutputs();
  void makeChecks();
  void makeCorrections();
  std::unique_ptr<render::frame::Correction> correctionOf(const render::out::OutputSettings& output,
                                                          std::vector<AlignedOutput>& aligned);
  void makeSignals();

  CorrectedOutputsParts parts_;
  render::out::kms::Cards graphics_cards_;  // their displays, shared by the outputs on them
  render::out::OutputSet outputs_{{}};
  std::optional<render::out::PictureChecks> checks_;  // of outputs_
  ThreadTeam team_;  // threads for the corrections; used on the wall's thread
  render::correct::ShaderPass shader_pass_;  // of the corrections, where a GPU computes them
  std::vector<std::unique_ptr<render::frame::Correction>> corrections_;
  std::string uncorrected_;
  std::unique_ptr<SignalTaps> signals_;
  std::unique_ptr<Aligner> aligner_;  // replaces corrections
  render::out::WindowActs window_;
};

// Whether signals that this renderer corrects are drawn into displays' memory where that is
// possible. Pure.
bool drawsIntoDisplays(const render::frame::RenderSettings& settings,
                       const render::gl::RendererInfo& renderer);

// Name of the shared-memory object that the frame is in, if an output of kind shared_memory shows
// it; empty otherwise.
std::string sharedFrameName(const Settings& settings);

}  // namespace merlin::wall
