// CorrectedOutputs: owns the outputs of the configuration, each with the correction of its picture,
// the check of what it shows and the tap of its signal; and the aligner of all of them.
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

// How signals that the GPU corrects get to the displays.
struct ScanOutReport {
  // Whether the last signal of at least one output was drawn into the memory that its display
  // shows.
  bool drawn = false;
  std::string fault{};  // why a signal is copied that could be drawn; empty: none is
};

// What CorrectedOutputs needs. All that is referred to must outlive it.
struct CorrectedOutputsParts {
  const Settings& settings;  // `wall` is drawnWall() of the configured one
  const render::tiles::TilePlan& plan;
  std::uint64_t generation = 0;  // differs in each run of the daemon
  render::testcard::CardOverlay& cards;
  state::StateKeeper& keeper;
  KeptFiles& kept_files;
  ThreadWatch& watch;
  Clock& clock;
  // Place of the operator's panel in the frame; nothing: there is no panel.
  std::optional<PanelPointer::Place> panel{};
};

// Thread-bound to the wall's thread once this thread runs, except for aligner() and signals(),
// whose members are thread-safe where they say so, uncorrected(), scanOut() and set().mend().
class CorrectedOutputs {
 public:
  // Opens the outputs. If an output is of kind kms, make() must be called before any drawing
  // context is created. Errors: those of makeOutput(), with the output's name.
  static Result<std::unique_ptr<CorrectedOutputs>> make(const CorrectedOutputsParts& parts);
  ~CorrectedOutputs() = default;
  CorrectedOutputs(const CorrectedOutputs&) = delete;
  CorrectedOutputs& operator=(const CorrectedOutputs&) = delete;

  // Sets the functions that outputs of kind window call, on their own threads, to execute what the
  // person at the window does.
  void onWindow(render::out::WindowActs acts) { window_ = std::move(acts); }

  render::out::OutputSet& set() { return outputs_; }
  // Starts to check regularly what the outputs show.
  void startChecks() { checks_->start(parts_.watch); }
  // Returns the corrections by output number; null for an output that is sent the uncorrected
  // frame. To be called once; the caller must keep them until close().
  std::vector<std::unique_ptr<render::frame::Correction>> takeCorrections() {
    return std::move(corrections_);
  }
  render::correct::ShaderPass& shaderPass() { return shader_pass_; }
  // Returns how corrected signals get to the displays. Thread-safe until close() is called.
  ScanOutReport scanOut() const;

  Aligner& aligner() { return *aligner_; }
  SignalTaps& signals() { return *signals_; }
  // Returns a text about which outputs are shown without the correction that was measured for them,
  // and why; empty: none. Does not change while the wall runs.
  const std::string& uncorrected() const noexcept { return uncorrected_; }

  // Closes all outputs and destroys the aligner. Outputs of kind window execute commands until
  // then, so close() must be called before anything that these commands use is destroyed.
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
  render::out::kms::Cards graphics_cards_;  // shared by the outputs on their displays
  render::out::OutputSet outputs_{{}};
  std::optional<render::out::PictureChecks> checks_;  // checks of outputs_
  ThreadTeam team_;  // threads that compute corrections; used by the wall's thread
  render::correct::ShaderPass shader_pass_;  // computes the corrections on a GPU
  std::vector<std::unique_ptr<render::frame::Correction>> corrections_;
  std::string uncorrected_;
  std::unique_ptr<SignalTaps> signals_;
  std::unique_ptr<Aligner> aligner_;  // replaces the corrections after a change
  render::out::WindowActs window_;
};

// Whether signals that this renderer corrects are to be drawn directly into the memory of displays
// where this is possible. Pure.
bool drawsIntoDisplays(const render::frame::RenderSettings& settings,
                       const render::gl::RendererInfo& renderer);

// Returns the name of the shared memory with the frame if an output of kind shared_memory is
// configured; empty otherwise.
std::string sharedFrameName(const Settings& settings);

}  // namespace merlin::wall
