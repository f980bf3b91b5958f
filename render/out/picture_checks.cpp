#include "render/out/picture_checks.h"

#include <algorithm>

#include <fmt/format.h>

namespace merlin::render::out {
namespace {

constexpr Duration kSoon = std::chrono::milliseconds(500);
constexpr Duration kStep = std::chrono::milliseconds(500);  // longest time without a sign of life

std::string sentence(PictureVerdict verdict, const DisplayReading& reading) {
  const std::string at = reading.where.empty() ? "" : ", at " + reading.where;
  switch (verdict) {
    case PictureVerdict::kUnchecked:
    case PictureVerdict::kRight: return {};
    case PictureVerdict::kBlack: return "is black instead of what was meant" + at;
    case PictureVerdict::kFrozen: return "stands still on an older frame" + at;
    case PictureVerdict::kTorn: return "shows parts of two frames" + at;
    case PictureVerdict::kForeign: break;
  }
  if (reading.programs.empty()) return "shows a picture that is not the wall's" + at;
  return fmt::format("shows a picture that is not the wall's{}; the card is also open in {}", at,
                     reading.programs);
}

}  // namespace

PictureChecks::PictureChecks(const std::vector<Checked>& outputs, const Clock& clock)
    : clock_(clock) {
  const Timestamp now = clock.now();
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    Entry& entry = entries_.emplace_back();
    entry.checked = outputs[i];
    if (!outputs[i].output->canReadBack()) entry.checked.every = Duration::zero();
    // The outputs' first checks are spread over the interval.
    const auto turn = static_cast<std::int64_t>(i) + 1;
    entry.due = now + entry.checked.every * turn / static_cast<std::int64_t>(outputs.size());
  }
}

void PictureChecks::start(ThreadWatch& watch) {
  const auto is_checked = [](const Entry& e) { return e.checked.every > Duration::zero(); };
  if (std::ranges::none_of(entries_, is_checked)) return;
  thread_ = WatchedThread(
      watch, "picture checks", [this](const std::stop_token& stop, Progress& progress) {
        giveWay();
        while (!stop.stop_requested()) {
          const Timestamp due = step().value_or(clock_.now() + kStep);
          progress.step();
          const Duration wait = std::clamp<Duration>(due - clock_.now(), Duration::zero(), kStep);
          std::unique_lock lock(idle_mutex_);
          idle_.wait_for(lock, stop, wait, [] { return false; });
        }
      });
}

// A frame with the same digest as the one before it is not recorded: nobody can see which of the
// two is shown.
void PictureChecks::meant(std::size_t i, const Signal& signal) {
  Entry& entry = entries_[i];
  if (entry.checked.every == Duration::zero() || signal.pixels.empty()) return;
  entry.wants_frame = false;
  const auto pitch = static_cast<std::size_t>(signal.width) * 4;
  const PictureDigest digest =
      digestOf({signal.width, signal.height, signal.pixels, pitch, PixelOrder::kRgba});
  const std::uint64_t written = entry.written.load(std::memory_order_relaxed);
  if (written > 0 && digest == entry.last) return;
  entry.last = digest;
  entry.slots[written % kRemembered].publish({toNanoseconds(clock_.now()), digest});
  entry.written.store(written + 1, std::memory_order_release);
}

// Returns the last frames, oldest first. If one was overwritten meanwhile, it and all older ones
// are left out.
std::vector<MeantPicture> PictureChecks::meantOf(const Entry& entry) {
  std::vector<MeantPicture> meant;
  const std::uint64_t written = entry.written.load(std::memory_order_acquire);
  const std::uint64_t most = std::min<std::uint64_t>(written, kRemembered);
  for (std::uint64_t back = 1; back <= most; ++back) {
    const auto frame = entry.slots[(written - back) % kRemembered].read();
    if (!frame) break;
    const Timestamp handed_over = fromNanoseconds(frame->handed_over_ns);
    if (!meant.empty() && handed_over > meant.back().handed_over) break;
    meant.push_back({frame->digest, handed_over});
  }
  std::ranges::reverse(meant);
  return meant;
}

std::optional<Timestamp> PictureChecks::step() {
  std::optional<Timestamp> next;
  Entry* turn = nullptr;
  for (Entry& entry : entries_) {
    if (entry.checked.every == Duration::zero() || (turn && entry.due >= turn->due)) continue;
    turn = &entry;
  }
  if (!turn) return std::nullopt;
  if (turn->due <= clock_.now()) check(*turn);
  for (const Entry& entry : entries_) {
    if (entry.checked.every == Duration::zero()) continue;
    next = std::min(next.value_or(entry.due), entry.due);
  }
  return next;
}

void PictureChecks::check(Entry& entry) {
  const Timestamp began = clock_.now();
  const auto read = entry.checked.output->readBack();
  const auto readings = read ? *read : std::vector<DisplayReading>();
  // An output that is being set up again shows nothing for a while; its last state, which is wrong,
  // then remains.
  const bool is_mended = isWrong(entry.steady.current()) && began < entry.mend_at;
  PictureState state = entry.last_state;
  if (!readings.empty() || !is_mended) state = judge(entry, readings, began);
  const Timestamp now = clock_.now();
  state.took_ms = static_cast<float>(1000 * toSeconds(now - began));
  entry.last_state = state;
  entry.state.publish(state);
  const bool soon = isWrong(state.verdict) || entry.steady.isUnsettled();
  if (isWrong(state.verdict) && now >= entry.mend_at) {
    entry.mend_at = now + entry.checked.every;
    entry.checked.output->showAgain();
    entry.wants_frame = true;
  }
  entry.due = now + (soon ? std::min(kSoon, entry.checked.every) : entry.checked.every);
}

// Returns the state of an output, which is that of its worst display: the highest PictureVerdict.
PictureState PictureChecks::judge(Entry& entry, const std::vector<DisplayReading>& readings,
                                  Timestamp began) {
  // Read after the displays, since a frame that was handed over meanwhile may already be shown.
  const std::vector<MeantPicture> meant = meantOf(entry);
  PictureVerdict worst = PictureVerdict::kUnchecked;
  std::string says;
  for (const DisplayReading& reading : readings) {
    const auto right = entry.last_right.find(reading.where);
    const PictureVerdict verdict = judgePicture(
        meant, reading.found,
        right == entry.last_right.end() ? std::nullopt : std::optional(right->second), began);
    if (verdict == PictureVerdict::kRight) entry.last_right[reading.where] = reading.found.digest;
    if (verdict <= worst) continue;
    worst = verdict;
    says = sentence(verdict, reading);
  }
  PictureState state{};
  state.verdict = entry.steady.update(worst);
  if (isWrong(state.verdict)) says.copy(state.says, sizeof state.says - 1);
  return state;
}

}  // namespace merlin::render::out
