// The part of the loop that publishes its statistics in shared memory.
#include <algorithm>
#include <iterator>

#include "daemon/wall/wall_loop.h"

namespace merlin::wall {
namespace {

constexpr Duration kMinute = std::chrono::seconds(60);
constexpr Duration kSecond = std::chrono::seconds(1);

float ms(Duration d) { return static_cast<float>(1000 * toSeconds(d)); }

}  // namespace

void WallLoop::publishTrace(Timestamp now) {
  tracer_.end(now, static_cast<std::uint32_t>(detail().costOf(step_)));
  if (p_.trace) p_.trace->publish(tracer_.frame());
}

void WallLoop::publishStats(Timestamp now) {
  stats_.advance(now);
  out_.updated_ns = toNanoseconds(now);
  out_.frames = frames_;
  out_.deadlines = stats_.deadlines();
  out_.late = stats_.late();
  out_.triangles = static_cast<std::uint32_t>(detail().costOf(step_));
  out_.level = static_cast<std::uint32_t>(step_);
  out_.levels = static_cast<std::uint32_t>(detail().steps());
  out_.moving = view_.moving;
  out_.full_detail = full_detail_;
  out_.longest_late = stats_.longestLate();
  out_.late_share_1s = static_cast<float>(stats_.lateShare(now, kSecond));
  out_.late_share_1min = static_cast<float>(stats_.lateShare(now, kMinute));
  const double all = static_cast<double>(std::max<std::uint64_t>(stats_.deadlines(), 1));
  out_.late_share = static_cast<float>(static_cast<double>(stats_.late()) / all);
  out_.input_age_ms = ms(p_.feed.age());
  out_.grabbed = view_.grabbed;
  const std::string_view mode = view_.mode == render::BallMode::kFly ? "fly" : "object";
  std::fill(std::begin(out_.mode), std::end(out_.mode), '\0');
  std::copy(mode.begin(), mode.end(), out_.mode);
  paceStats(now);
  p_.stats.publish(out_);
  if (p_.interaction) publishInteraction(now);
  if (p_.outputs) publishOutputs(now);
}

std::optional<Eigen::Vector3f> WallLoop::pointedAt() const {
  if (!view_.pointed) return std::nullopt;
  return view_.pointed->at_eye_m;
}

void WallLoop::publishInteraction(Timestamp now) {
  shm::WallInteraction interaction{
      toNanoseconds(now), shm::WallInteraction::kNone, {-1, -1}, {}, 0, 0};
  if (const auto& pointed = view_.pointed) {
    interaction.pointing =
        pointed->on_model ? shm::WallInteraction::kAtModel : shm::WallInteraction::kAtWall;
    const auto pixel = p_.marker ? p_.marker->pixelOf(pointed->at_eye_m) : std::nullopt;
    if (pixel) std::copy_n(pixel->data(), 2, interaction.pixel);
    std::copy_n(pointed->at_model_m.data(), 3, interaction.at_model_m);
  }
  interaction.snapshots = snapshots_;
  interaction.content = static_cast<std::uint32_t>(content_);
  p_.interaction->publish(interaction);
}

void WallLoop::publishOutputs(Timestamp now) {
  const render::OutputSet& outputs = p_.delivery.outputs();
  shm::WallOutputs all{};
  all.count = static_cast<std::uint32_t>(std::min(outputs.size(), std::size(all.outputs)));
  for (std::size_t i = 0; i < all.count; ++i) {
    const render::OutputState& state = outputs.state(i);
    shm::OutputStats& o = all.outputs[i];
    outputs.name(i).copy(o.name, sizeof o.name - 1);
    outputs.kind(i).copy(o.kind, sizeof o.kind - 1);
    o.failed = state.fault.empty() ? 0 : 1;
    state.fault.copy(o.fault, sizeof o.fault - 1);
    o.frames = state.frames;
    o.shown_hz = static_cast<float>(outputs.shownHz(i, now));
    o.late_share = static_cast<float>(state.lateShare());
  }
  p_.outputs->publish(all);
}

void WallLoop::paceStats(Timestamp now) {
  const double now_hz = 1 / toSeconds(period_);
  out_.rate_asked_hz = static_cast<float>(asked_hz_);
  out_.rate_now_hz = static_cast<float>(now_hz);
  out_.rate_held_hz = static_cast<float>(stats_.heldRate(now, now_hz));
  out_.rate_divisor = static_cast<std::uint32_t>(rateDivisor());
  out_.scale_divisor = static_cast<std::uint32_t>(scale());
  out_.operator_coarser = operator_ladder_.rung() > 0;
  out_.work_median_ms = static_cast<float>(1000 * stats_.medianWorkSeconds());
  out_.utilisation = static_cast<float>(stats_.utilisation());
  out_.oscillation = static_cast<float>(stats_.oscillation());
  out_.settle_frames = stats_.settleFrames();
  out_.head_room = static_cast<float>(p_.governor.headRoom());
  out_.cost_fixed_ms = static_cast<float>(1000 * p_.governor.fixedSeconds());
  out_.cost_coefficient_us = static_cast<float>(1e6 * p_.governor.coefficient());
  out_.cost_exponent = static_cast<float>(p_.governor.exponent());
  out_.budget = static_cast<std::uint32_t>(p_.governor.budget());
  out_.held_triangles = p_.governor.held() ? out_.budget : 0;
  const auto& histogram = stats_.histogram();
  std::copy(histogram.begin(), histogram.end(), out_.work_histogram);
}

}  // namespace merlin::wall
