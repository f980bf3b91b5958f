// ./dev bench operator: the cost for each frame of drawing the plates and the panel over the
// operator's tile, compared with a memcpy of the tile.
#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "render/panel/panel_overlay.h"
#include "render/text/operator_overlay.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"
#include "tests/support/fake_clock.h"

namespace merlin::bench {
namespace {

using Steady = std::chrono::steady_clock;
using namespace render::text;

double msSince(Steady::time_point then) {
  return std::chrono::duration<double, std::milli>(Steady::now() - then).count();
}

// The facts of a busy wall, which differ each time that they are read.
class BusyWall final : public OperatorSource {
 public:
  OperatorFacts read(Timestamp) override {
    OperatorFacts f;
    f.rate_asked_hz = f.rate_now_hz = 30;
    f.rate_held_hz = 29.8;
    f.cost = ++reads_;
    f.full_cost = 69'636;
    f.budget = 14'000;
    f.cost_unit = "triangles";
    f.content = "ankylosaurus";
    f.mode = "moves the model";
    f.posture = "fist";
    f.devices = {{"glove", "ok", DeviceLight::kGood},
                 {"tracker", "opening", DeviceLight::kWaiting},
                 {"ball", "absent", DeviceLight::kBad}};
    f.messages.assign(4, {"frame rate reduced to 15 of 30 Hz: there is too little time", 1});
    for (std::size_t i = 0; i < kChartColumns; ++i)
      f.chart[i] = {static_cast<std::uint8_t>(60 + i % 50), i % 60 == 0};
    return f;
  }

 private:
  std::uint32_t reads_ = 0;
};

struct Times {
  std::vector<double> redrawn, kept, copied;  // [ms]
};

render::tiles::TilePlan planOf(int width, int height) {
  render::tiles::TilesSettings settings;
  settings.frame_width = settings.tile_width = width;
  settings.frame_height = settings.tile_height = height;
  settings.tiles = {{"operator", render::tiles::TileKind::kOperator, 0, 0, 0}};
  const auto plan = render::tiles::planTiles(settings);
  if (!plan) didNotRun("the tile", plan.error().what, "fix the benchmark");
  return *plan;
}

// Measures the overlay, which draws anew in every third frame; calls before() before each frame
// with the frame's number.
template <typename Before>
Times measureOverlay(render::frame::Overlay& overlay, std::size_t bytes, int frames,
                     const Before& before) {
  std::vector<std::uint8_t> canvas(bytes, 90), copy(bytes);
  Times times;
  for (int i = 0; i < 3 * frames; ++i) {
    before(i);
    auto began = Steady::now();
    overlay.draw(canvas);
    overlay.erase(canvas);
    (i % 3 == 0 ? times.redrawn : times.kept).push_back(msSince(began));
    began = Steady::now();
    std::memcpy(copy.data(), canvas.data(), bytes);
    asm volatile("" : : "r"(copy.data()) : "memory");
    times.copied.push_back(msSince(began));
  }
  return times;
}

Times measureTile(int width, int height, int frames) {
  const render::tiles::TilePlan plan = planOf(width, height);
  BusyWall source;
  test::FakeClock clock;
  const auto overlay = OperatorOverlay::make(plan, source, clock);
  if (!overlay) didNotRun("the overlay", overlay.error().what, "fix the benchmark");
  // The plates are drawn anew ten times a second: every third frame at 30 Hz.
  return measureOverlay(**overlay, static_cast<std::size_t>(4 * width * height), frames,
                        [&](int) { clock.advance(std::chrono::milliseconds(34)); });
}

// A panel whose view changes in every third frame.
class BusyPanel final : public render::panel::PanelSource {
 public:
  const render::panel::PanelView& view() override { return shown; }
  render::panel::PanelView shown;
};

Times measurePanel(int width, int height, int frames) {
  const render::tiles::TilePlan plan = planOf(width, height);
  render::panel::PanelOptions options;
  options.contents = {{"ankylosaurus", true}, {"map", false}};
  options.projectors = options.video = options.lamp = true;
  const auto place = render::panel::placePanel(plan, options);
  BusyPanel source;
  source.shown.facts.content = "ankylosaurus";
  source.shown.facts.projectors = "warming";
  if (!place) didNotRun("the panel", "it has no place", "fix the benchmark");
  const auto overlay = render::panel::PanelOverlay::make(plan, *place, options, source);
  if (!overlay) didNotRun("the panel", overlay.error().what, "fix the benchmark");
  return measureOverlay(**overlay, static_cast<std::size_t>(4 * width * height), frames,
                        [&](int i) { source.shown.facts.rate_hz = 30 + i / 3; });
}

void reportTile(const std::string& name, const Times& times, Report& report) {
  const Measured redrawn = medianOf(times.redrawn, "frames that draw " + name);
  const Measured kept = medianOf(times.kept, "frames that keep what is drawn of " + name);
  const Measured copied = medianOf(times.copied, "copies of " + name);
  const Measured ratio = ratioOf(kept, copied, name + " beside memcpy");
  report.text(
      "  {:<15} {:6.2f} ms a frame, {:.1f} memcpys of the tile; {:6.2f} ms where it is drawn "
      "anew\n",
      name, kept.value(), ratio.value(), redrawn.value());
  report.figure(name + "_kept_ms", kept, "ms");
  report.figure(name + "_redrawn_ms", redrawn, "ms");
  report.figure(name + "_kept_per_memcpy", ratio, "1");
}

bool measure(int frames, Report& report) {
  report.text("plates over the operator's tile, drawn and erased, medians\n");
  reportTile("640x480", measureTile(640, 480, frames), report);
  reportTile("1920x1080", measureTile(1920, 1080, frames), report);
  report.text("the panel\n");
  reportTile("panel_640x480", measurePanel(640, 480, frames), report);
  reportTile("panel_1920x1080", measurePanel(1920, 1080, frames), report);
  return true;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::CommandLine app(
      "The cost of the plates and the panel over the operator's tile for each frame");
  int frames = 100;
  app.option("--frames", frames, "Number of frames that draw the plates anew").range(1, 100'000);
  return app.run("operator", argc, argv, [&](merlin::bench::Report& report) {
    return merlin::bench::measure(frames, report);
  });
}
