#include "daemon/wall/alignment_fit.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "render/stereo/eye_tiles.h"

namespace merlin::wall {
namespace {

using render::correct::CorrectionSettings;

// A corner may be outside the output by at most this share of its width or height, so that the
// image does not disappear.
constexpr double kMostOutside = 0.5;

double outside(double place, double size) { return std::max({0.0, -place, place - size}); }

// Returns why offsets that were made for the form `aligned` are not valid for an output of the form
// `now`. REQUIRES: !aligned.fits(now).
std::string formMisfit(const state::OutputForm& aligned, const state::OutputForm& now) {
  state::OutputForm same = aligned;
  same.corners = now.corners;
  if (same == now)
    return "its corners in the configuration are not those with which it was aligned";
  return fmt::format(
      "it was made for {} x {} pixels and a mesh of {} x {} points, but the output now has "
      "{} x {} pixels and a mesh of {} x {} points",
      aligned.width, aligned.height, aligned.mesh_columns, aligned.mesh_rows, now.width, now.height,
      now.mesh_columns, now.mesh_rows);
}

}  // namespace

state::OutputForm formOf(const AlignedOutput& output) {
  const render::correct::MeshSettings& mesh = output.configured.mesh;
  return {output.name,  output.width, output.height,
          mesh.columns, mesh.rows,    output.configured.corners};
}

CorrectionSettings alignedSettings(const AlignedOutput& output, const state::Alignment& alignment) {
  CorrectionSettings settings = output.configured;
  const state::OutputAlignment* const of = alignment.find(output.name);
  if (!of) return settings;
  for (const auto& [place, by] : of->moved) {
    if (place.of == state::Place::Of::kPin) {
      moveCorner(settings, place.corner(), by.x, by.y);
    } else {
      moveMeshPoint(settings.mesh, place.column, place.row,
                    {by.x / output.width, by.y / output.height});
    }
  }
  return settings;
}

Result<Ok> checkAlignment(const AlignedOutput& output, const state::Alignment& alignment) {
  const auto misfit = [](std::string what) {
    return Error{Errc::kInvalidArgument, std::move(what)};
  };
  if (!output.fixed.empty() && alignment.find(output.name)) return misfit(output.fixed);
  const double width = output.width, height = output.height;
  const CorrectionSettings settings = alignedSettings(output, alignment);
  const auto faults = validate(settings, output.width, output.height);
  if (!faults.empty())
    return misfit(fmt::format("{} {}", faults[0].pointer.substr(1), faults[0].what));
  for (std::size_t i = 0; i < 4; ++i) {
    const state::Place corner = state::cornerAt(i);
    const double x = corner.column * width + settings.corners[2 * i],
                 y = corner.row * height + settings.corners[2 * i + 1];
    if (alignment.offset(output.name, corner) == state::Offset{}) continue;  // not moved: no limit
    if (outside(x, width) <= kMostOutside * width && outside(y, height) <= kMostOutside * height)
      continue;
    return misfit(
        fmt::format("corner {} would be at ({}, {}), more than half the output's {} x "
                    "{} pixels outside of it",
                    state::nameOf(corner), x, y, width, height));
  }
  return Ok{};
}

std::string misfitOf(const AlignedOutput& output, const state::Alignment& alignment) {
  const state::OutputAlignment* const of = alignment.find(output.name);
  if (!of) return {};
  const state::OutputForm now = formOf(output);
  if (!of->form.fits(now)) return formMisfit(of->form, now);
  const auto good = checkAlignment(output, alignment);
  return good ? std::string() : good.error().what;
}

std::string fixedOf(const render::out::OutputSettings& output,
                    const render::tiles::TilesSettings& tiles) {
  if (render::stereo::signalParts(output, tiles)) return {};
  return "its pictures of both eyes are not the halves of its signal; let it show one tile, or use "
         "stereo mode two_outputs or anaglyph";
}

Fitted fitAlignment(const AlignedOutput& output, state::Alignment& alignment,
                    state::SetAside& set_aside) {
  Fitted fitted;
  if (std::string why = misfitOf(output, alignment); !why.empty()) {
    state::Alignment taken = alignment.take(output.name);
    fitted.is_changed = true;
    if (!taken.isNothing()) fitted.aside_why = std::move(why);
    set_aside.add(std::move(taken));
  }
  if (alignment.find(output.name)) return fitted;
  const auto back = set_aside.take([&](const state::Alignment& aside) {
    if (aside.outputs.front().form.output != output.name) return false;
    state::Alignment with = alignment;
    with.put(aside);
    return with.moved() <= state::kMostMoved && misfitOf(output, with).empty();
  });
  if (back) {
    alignment.put(*back);
    fitted.is_changed = fitted.is_back = true;
  }
  return fitted;
}

std::vector<FittedOutput> fittedOutputs(const WallSettings& drawn, state::Alignment alignment,
                                        state::SetAside set_aside) {
  std::vector<FittedOutput> changed;
  for (const render::out::OutputSettings& settings : drawn.outputs) {
    if (settings.kind == render::out::OutputKind::kSharedMemory) continue;  // cannot be aligned
    const auto size = render::out::pictureSize(settings, drawn.tiles);
    if (!size) continue;
    AlignedOutput output{settings.shownName(), size->width, size->height, settings.correction, {}};
    output.fixed = fixedOf(settings, drawn.tiles);
    Fitted fitted = fitAlignment(output, alignment, set_aside);
    if (fitted.is_changed) changed.push_back({output.name, std::move(fitted)});
  }
  return changed;
}

}  // namespace merlin::wall
