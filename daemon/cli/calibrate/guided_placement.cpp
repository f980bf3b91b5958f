#include "daemon/cli/calibrate/guided_placement.h"

#include <algorithm>
#include <memory>

#include "daemon/base/clock.h"
#include "daemon/cli/calibrate/ignoring_sink.h"
#include "daemon/cli/print.h"
#include "drivers/fastrak/guided_alignment.h"
#include "drivers/port/tracker_placement.h"
#include "drivers/registry.h"

namespace merlin::cli {
namespace {

using fastrak::GuidedAlignment;

// Measures a station by opening the line of the tracker, in the frame in which the tracker sends
// its poses.
class GuidedSender final : public Guided, private IgnoringSink {
 public:
  GuidedSender(const OwnLine& line, const DriverEntry& driver, int station, const Clock& clock)
      : stream_(*line.stream),
        device_(driver.make(asSent(line.settings.own), clock, *this)),
        station_(static_cast<std::uint32_t>(station)),
        alignment_({}) {}

  Result<std::string> open() { return device_->open(stream_); }
  Result<Ok> listen(bool measuring) override {
    measuring_ = measuring;
    return device_->poll(stream_);
  }
  void begin(std::size_t step) override { alignment_.begin(step); }
  Result<std::string> end() override {
    const auto held = alignment_.end();
    if (!held) return held.error();
    const auto& p = held->position_m;
    return fmt::format("{} samples, mean position {:.3f} {:.3f} {:.3f} m, all within {:.1f} cm",
                       held->samples, p[0], p[1], p[2], 100 * held->spread_m);
  }
  std::string now() const override {
    if (newest_.station == 0) return "no sample yet";
    const auto& p = newest_.position_m;
    return fmt::format("x {:7.3f}  y {:7.3f}  z {:7.3f} m", p[0], p[1], p[2]);
  }
  Result<TrackerPlacement> solve() const {
    const auto cm = alignment_.solve().alignment_cm;
    const auto place = [&](std::size_t at) {
      return std::array<double, 3>{cm[at] / 100.0, cm[at + 1] / 100.0, cm[at + 2] / 100.0};
    };
    return placementOf(place(0), place(3), place(6));
  }

 private:
  static DriverSettings asSent(DriverSettings settings) {
    settings.vrpn.placement = settings.osc.placement = {};
    return settings;
  }
  void publish(const TrackerSample& sample) noexcept override {
    if (sample.station != station_) return;
    newest_ = sample;
    if (measuring_) alignment_.add(sample);
  }

  ByteStream& stream_;
  std::unique_ptr<Device> device_;
  std::uint32_t station_;
  GuidedAlignment alignment_;
  TrackerSample newest_{};
  bool measuring_ = false;
};

}  // namespace

Result<Ok> guidePlacement(const CalibratedDevice& tracker, int station, const GuideTiming& timing) {
  const auto line = openOwnLine(tracker, "", 0);
  if (!line) return line.error();
  const SystemClock clock;
  GuidedSender guided(*line, *findDriver(tracker.driver), station, clock);
  const auto identity = guided.open();
  if (!identity) return identity.error();
  printOut("{}, station {}: {}\n", tracker.name, station, *identity);
  const auto places = fastrak::alignmentSteps().first(fastrak::kAhead);
  if (auto done = guide(places, timing, guided); !done) return done;
  const auto solved = guided.solve();
  if (!solved) return solved.error();
  printOut("\n");
  return saveChecked(tracker, SampleKind::kTracker,
                     {{"axes", solved->axes}, {"origin_m", numbers(solved->origin_m)}});
}

}  // namespace merlin::cli
