#include "daemon/wall/corrected_outputs.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "daemon/shm/segment.h"
#include "daemon/wall/aligned_output.h"
#include "render/frame/correction_chain.h"
#include "render/frame/tile_arrangement.h"
#include "render/stereo/eye_tiles.h"
#include "render/testcard/card_tiles.h"

namespace merlin::wall {
namespace {

std::string frameNameOf(const Settings& settings) {
  return shm::segmentName(settings.instance, "framebuffer");
}

}  // namespace

bool drawsIntoDisplays(const render::frame::RenderSettings& settings,
                       const render::gl::RendererInfo& renderer) {
  return !renderer.software && settings.scan_out == render::frame::ScanOutMode::kAuto;
}

std::string sharedFrameName(const Settings& settings) {
  const bool shared =
      std::ranges::any_of(settings.wall.outputs, [](const render::out::OutputSettings& output) {
        return output.kind == render::out::OutputKind::kSharedMemory;
      });
  return shared ? frameNameOf(settings) : "";
}

CorrectedOutputs::CorrectedOutputs(const CorrectedOutputsParts& parts)
    : parts_(parts), graphics_cards_(parts.kept_files, parts.watch, parts.clock) {}

Result<std::unique_ptr<CorrectedOutputs>> CorrectedOutputs::make(
    const CorrectedOutputsParts& parts) {
  std::unique_ptr<CorrectedOutputs> outputs(new CorrectedOutputs(parts));
  if (const auto made = outputs->makeOutputs(); !made) return made.error();
  outputs->makeChecks();
  outputs->graphics_cards_.open();
  outputs->makeCorrections();
  outputs->makeSignals();
  return outputs;
}

Result<Ok> CorrectedOutputs::makeOutputs() {
  // The lambdas access window_ only when they are called, because it is set after the outputs are
  // made.
  const render::out::WindowActs window{
      [this](const std::string& name, const std::string& argument) {
        return window_.command(name, argument);
      },
      [this](const std::string& why) { window_.stop(why); }};
  const WallSettings& wall = parts_.settings.wall;
  std::vector<render::out::NamedOutput> outputs;
  for (const render::out::OutputSettings& settings : wall.outputs) {
    auto output = render::out::makeOutput(
        settings, {parts_.plan, frameNameOf(parts_.settings), parts_.generation, parts_.watch,
                   parts_.clock, wall.tiles, graphics_cards_, window, parts_.panel});
    if (!output)
      return Error{output.error().code,
                   fmt::format("output {}: {}", settings.shownName(), output.error().what)};
    outputs.push_back({settings.shownName(), nameOf(settings.kind), *std::move(output)});
  }
  outputs_ = render::out::OutputSet(std::move(outputs));
  return Ok{};
}

void CorrectedOutputs::makeChecks() {
  std::vector<render::out::PictureChecks::Checked> checked;
  for (std::size_t i = 0; i < outputs_.size(); ++i)
    checked.push_back({&outputs_.output(i), fromSeconds(parts_.settings.wall.outputs[i].check_s)});
  checks_.emplace(checked, parts_.clock);
  outputs_.checkWith(&*checks_);
}

// Outputs of kind shared_memory receive the frame without correction; all others can be aligned.
void CorrectedOutputs::makeCorrections() {
  std::vector<AlignedOutput> aligned;
  std::vector<std::string> refused;
  for (const render::out::OutputSettings& output : parts_.settings.wall.outputs) {
    if (output.kind == render::out::OutputKind::kSharedMemory) {
      refused.push_back(output.shownName());
      corrections_.push_back(nullptr);
    } else {
      corrections_.push_back(correctionOf(output, aligned));
    }
  }
  aligner_ = std::make_unique<Aligner>(std::move(aligned), std::move(refused), parts_.cards,
                                       parts_.keeper, parts_.watch);
}

// Returns the correction that the aligner can replace, after the output's own arrangement of tiles
// if it has one.
std::unique_ptr<render::frame::Correction> CorrectedOutputs::correctionOf(
    const render::out::OutputSettings& output, std::vector<AlignedOutput>& aligned) {
  const render::tiles::TilesSettings& tiles = parts_.settings.wall.tiles;
  const auto parts = render::stereo::signalParts(output, tiles);
  std::string unreadable;
  AlignedOutput made = alignedOutput(output, *render::out::pictureSize(output, tiles),
                                     parts.value_or(render::correct::SignalParts{}), team_,
                                     shader_pass_, unreadable);
  if (!unreadable.empty())
    uncorrected_ += fmt::format(
        "{}output {} is shown without its measured warp and blend: {}; mend the file and restart "
        "the wall",
        uncorrected_.empty() ? "" : "; ", output.shownName(), unreadable);
  std::vector<std::unique_ptr<render::frame::Correction>> links;
  if (!output.tiles.empty())
    links.push_back(std::make_unique<render::frame::TileArrangement>(parts_.plan, output.tiles));
  auto correction = std::make_unique<render::frame::ReplaceableCorrection>();
  made.correction = correction.get();
  for (std::size_t corner = 0; corner < made.marks.size(); ++corner)
    made.marks[corner] = render::testcard::cornerOf(parts_.plan, output, corner);
  links.push_back(std::move(correction));
  made.fixed = fixedOf(output, tiles);
  aligned.push_back(std::move(made));
  if (links.size() == 1) return std::move(links.front());
  return std::make_unique<render::frame::CorrectionChain>(std::move(links));
}

void CorrectedOutputs::makeSignals() {
  std::vector<TappedOutput> outputs;
  for (const render::out::OutputSettings& output : parts_.settings.wall.outputs) {
    const render::out::PictureSize size =
        *render::out::pictureSize(output, parts_.settings.wall.tiles);
    outputs.push_back({output.shownName(), size.width, size.height});
  }
  signals_ = std::make_unique<SignalTaps>(parts_.settings.instance, std::move(outputs),
                                          parts_.generation, parts_.clock);
}

ScanOutReport CorrectedOutputs::scanOut() const {
  std::string fault = shader_pass_.drawFault();
  if (fault.empty()) fault = outputs_.copyReason();
  return {outputs_.draws(), std::move(fault)};
}

void CorrectedOutputs::close() {
  checks_.reset();
  outputs_ = render::out::OutputSet({});
  aligner_.reset();
}

}  // namespace merlin::wall
