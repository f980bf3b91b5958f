#include "daemon/wall/wall_publisher.h"

#include <algorithm>
#include <iterator>
#include <type_traits>

#include "daemon/base/fixed_text.h"
#include "render/out/settings.h"

namespace merlin::wall {
namespace {

template <std::size_t size>
void copyText(std::string_view text, char (&to)[size]) {
  std::fill(std::begin(to), std::end(to), '\0');
  text.copy(to, size - 1);
}

void fillDetail(shm::WallStats& out, const WallPublisher::State& s) {
  const render::content::DetailAxis& detail = s.turns.detail();
  out.detail_step = static_cast<std::uint32_t>(s.step);
  out.detail_steps = static_cast<std::uint32_t>(detail.steps());
  out.cost = static_cast<std::uint32_t>(detail.costOf(s.step));
  out.full_cost = static_cast<std::uint32_t>(detail.fullCost());
  copyText(detail.unit(), out.cost_unit);
  out.least_cost = static_cast<std::uint32_t>(s.governor.least());
  out.budget = static_cast<std::uint32_t>(s.governor.budget());
  out.held_cost = s.governor.held() ? out.budget : 0;
}

void fillFrames(shm::WallStats& out, const FrameStats& frames, Timestamp now) {
  out.deadlines = frames.deadlines();
  out.late = frames.late();
  out.longest_late = frames.longestLate();
  out.late_share_1s = static_cast<float>(frames.lateShare(now, FrameStats::kSecond));
  out.late_share_1min = static_cast<float>(frames.lateShare(now, FrameStats::kMinute));
  const double all = static_cast<double>(std::max<std::uint64_t>(frames.deadlines(), 1));
  out.late_share = static_cast<float>(static_cast<double>(frames.late()) / all);
  out.work_median_ms = static_cast<float>(1000 * frames.medianWorkSeconds());
  out.utilisation = static_cast<float>(frames.utilisation());
  out.oscillation = static_cast<float>(frames.oscillation());
  out.settle_frames = frames.settleFrames();
  const auto& histogram = frames.histogram();
  std::copy(histogram.begin(), histogram.end(), out.work_histogram);
}

void fillPace(shm::WallStats& out, const WallPublisher::State& s, Timestamp now) {
  const double now_hz = 1 / toSeconds(s.pace.period());
  out.rate_asked_hz = static_cast<float>(s.pace.askedHz());
  out.rate_now_hz = static_cast<float>(now_hz);
  out.rate_held_hz = static_cast<float>(s.frames.heldRate(now, now_hz));
  out.rate_divisor = static_cast<std::uint32_t>(s.pace.rateDivisor());
  out.scale_divisor = static_cast<std::uint32_t>(s.pace.sizeDivisor());
  out.operator_coarser = s.pace.operatorIsCoarser();
  out.ladder_steps = s.pace.changes();
  out.head_room = static_cast<float>(s.governor.headRoom());
  out.cost_fixed_ms = static_cast<float>(1000 * s.governor.fixedSeconds());
  out.cost_coefficient_us = static_cast<float>(1e6 * s.governor.coefficient());
  out.cost_exponent = static_cast<float>(s.governor.exponent());
}

}  // namespace

void WallPublisher::trace(const FrameTracer& tracer) {
  if (!slots_.trace) return;
  for (const shm::FrameTrace& frame : tracer.frames()) slots_.trace->publish(frame);
}

void WallPublisher::stats(shm::WallStats out, const State& s, Timestamp now) {
  out.updated_ns = toNanoseconds(now);
  out.moving = s.view.moving;
  out.grabbed = s.view.grabbed;
  copyText(s.view.mode == render::scene::BallMode::kFly ? "fly" : "object", out.mode);
  fillDetail(out, s);
  fillFrames(out, s.frames, now);
  fillPace(out, s, now);
  slots_.stats.publish(out);
}

void WallPublisher::interaction(shm::WallInteraction out, const render::scene::SceneView& view,
                                const render::frame::PointerMarker* marker, Timestamp now) {
  if (!slots_.interaction) return;
  out.updated_ns = toNanoseconds(now);
  out.pointing = shm::WallInteraction::kNone;
  std::fill(std::begin(out.pixel), std::end(out.pixel), -1);
  if (const auto& pointed = view.pointed) {
    out.pointing =
        pointed->on_model ? shm::WallInteraction::kAtModel : shm::WallInteraction::kAtWall;
    const auto pixel = marker ? marker->pixelOf(pointed->at_eye_m) : std::nullopt;
    if (pixel) std::copy_n(pixel->data(), 2, out.pixel);
    std::copy_n(pointed->at_model_m.data(), 3, out.at_model_m);
  }
  slots_.interaction->publish(out);
}

void WallPublisher::content(const ShownContent& shown, const ShowResult& result, Timestamp now) {
  if (!slots_.content) return;
  shm::WallContent content{};
  content.updated_ns = toNanoseconds(now);
  copyText(shown.name, content.name);
  copyText(shown.kind, content.kind);
  copyText(shown.slide, content.slide);
  content.finished = result.number;
  copyText(result.refused, content.refused);
  slots_.content->publish(content);
}

void WallPublisher::idle(const Playlist::Due& due, bool testcard, Timestamp now) {
  if (!slots_.idle) return;
  slots_.idle->publish({toNanoseconds(now), static_cast<float>(due.begins_s),
                        static_cast<float>(due.next_s), static_cast<float>(due.dims_s), testcard});
}

void WallPublisher::outputs(const render::out::OutputSet& outputs, Timestamp now) {
  if (!slots_.outputs) return;
  static_assert(std::extent_v<decltype(shm::WallOutputs::outputs)> == render::out::kMostOutputs);
  shm::WallOutputs all{};
  all.count = static_cast<std::uint32_t>(std::min(outputs.size(), std::size(all.outputs)));
  for (std::size_t i = 0; i < all.count; ++i) {
    const render::out::OutputState& state = outputs.state(i);
    shm::OutputStats& o = all.outputs[i];
    copyText(outputs.name(i), o.name);
    copyText(outputs.kind(i), o.kind);
    const std::string fault = outputs.faultNow(i);
    copyText(fault, o.fault);
    o.failed = fault.empty() ? 0 : 1;
    o.frames = state.frames;
    o.shown_hz = static_cast<float>(outputs.shownHz(i, now));
    o.late_share = static_cast<float>(state.lateShare());
    const render::out::PictureState picture = outputs.picture(i);
    o.picture = static_cast<std::uint32_t>(picture.verdict);
    o.picture_ms = picture.took_ms;
    copyText(textIn(picture.says), o.picture_fault);
  }
  slots_.outputs->publish(all);
}

}  // namespace merlin::wall
