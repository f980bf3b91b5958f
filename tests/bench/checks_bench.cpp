// ./dev bench checks: the cost of reading back what outputs show. Measures the digest of each
// frame, each check, and whether checks make frames late.
//
// The frames are those of the demo's wall, 1920 x 480 pixels; each is the frame before, moved by
// one row. They are presented to an output in shared memory after a wait that is as long as the
// demo's drawing. Runs without checks, with one check every 5 s (the default) and with one every 20
// ms take turns in one process with the same output. The cost for an output of a graphics card
// depends on the card's memory; the member `picture_ms` of the output's status shows it.
#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "render/image/image_file.h"
#include "render/out/output_set.h"
#include "render/out/picture_checks.h"
#include "render/out/shared_frame.h"
#include "tests/bench/command_line.h"
#include "tests/bench/demo_picture.h"
#include "tests/bench/figures.h"
#include "tests/support/temp_dir.h"

namespace merlin::bench {
namespace {

namespace out = render::out;

struct Options {
  double seconds = 6;
  int rounds = 3;
};

struct Counts {
  std::uint64_t due = 0, late = 0, wrong = 0;
  std::vector<double> present_ms, check_ms;
};

class Wall {
 public:
  Wall() : picture_(demoPicture()), plan_(planOf(picture_)) {
    auto shared =
        out::SharedFrameOutput::make("/" + test::privateName("bench-checks"), plan_, 1, clock_);
    if (!shared) didNotRun("shared memory", shared.error().what, "see /dev/shm");
    std::vector<out::NamedOutput> outputs;
    outputs.push_back({"shared", "shared_memory", *std::move(shared)});
    outputs_.emplace(std::move(outputs));
    for (auto& pixels : moved_) {
      pixels = picture_.pixels;
      std::rotate(pixels.begin(), pixels.begin() + 4L * picture_.width, pixels.end());
      picture_.pixels = pixels;
    }
  }
  const Picture& picture() const { return picture_; }

  // Presents frames on a grid of periods, with a check every `every`; 0: no checks.
  void run(Duration every, double seconds, Counts& counts) {
    out::PictureChecks checks({{&outputs_->output(0), every}}, clock_);
    outputs_->checkWith(&checks);
    ThreadWatch watch;
    checks.start(watch);
    const out::OutputState before = outputs_->state(0);
    const Duration period = fromSeconds(1 / kRate_hz);
    const Timestamp start = clock_.now();
    for (std::int64_t k = 0; toSeconds(clock_.now() - start) < seconds;) {
      const auto& pixels = moved_[static_cast<std::size_t>(k) % moved_.size()];
      clock_.sleepUntil(start + k * period + fromSeconds(kDrawingShare / kRate_hz), {});
      const Timestamp began = clock_.now();
      outputs_->present(0, {picture_.width, picture_.height, pixels},
                        {.sequence = ++sequence_, .finished = began}, start + (k + 1) * period);
      counts.present_ms.push_back(msOf(clock_.now() - began));
      const out::PictureState state = checks.state(0);
      if (state.took_ms > 0) counts.check_ms.push_back(static_cast<double>(state.took_ms));
      counts.wrong += out::isWrong(state.verdict) ? 1U : 0U;
      k = std::max(k + 1, static_cast<std::int64_t>((clock_.now() - start) / period));
    }
    checks.stop();
    outputs_->checkWith(nullptr);
    counts.due += outputs_->state(0).due - before.due;
    counts.late += outputs_->state(0).late - before.late;
  }

 private:
  SystemClock clock_;
  Picture picture_;
  // the picture, moved by one more row each; made before the measurement
  std::array<std::vector<std::uint8_t>, 8> moved_;
  render::tiles::TilePlan plan_;
  std::uint64_t sequence_ = 0;
  std::optional<out::OutputSet> outputs_;
};

void measureDigest(const Picture& picture, Report& report) {
  SystemClock clock;
  std::vector<std::uint8_t> copy(picture.pixels.size());
  std::vector<double> copies, digests;
  for (int i = 0; i < 300; ++i) {
    Timestamp began = clock.now();
    std::memcpy(copy.data(), picture.pixels.data(), copy.size());
    asm volatile("" : : "r"(copy.data()) : "memory");
    copies.push_back(msOf(clock.now() - began));
    began = clock.now();
    const out::PictureDigest digest = out::digestOf(
        {picture.width, picture.height, copy, static_cast<std::size_t>(picture.width) * 4});
    asm volatile("" : : "r"(&digest) : "memory");
    digests.push_back(msOf(clock.now() - began));
  }
  const Measured digest = medianOf(digests, "digests");
  const Measured share = scaled(digest, kRate_hz / 1000);
  const Measured ratio = ratioOf(digest, medianOf(copies, "copies"), "a digest beside memcpy");
  report.text(
      "digest of a frame, {} x {}: {:.4f} ms, {:.3f} % of a frame at {} Hz, {:.3f} memcpys\n",
      picture.width, picture.height, digest.value(), 100 * share.value(), kRate_hz, ratio.value());
  report.figure("digest_ms", digest, "ms");
  report.figure("digest_frame_share", share, "1");
  report.figure("digest_per_memcpy", ratio, "1");
}

bool measure(const Options& options, Report& report) {
  struct Case {
    const char* name;
    Duration every;
    Counts counts{};
  };
  std::array<Case, 3> cases{{{"unchecked", Duration::zero()},
                             {"every_5_s", std::chrono::seconds(5)},
                             {"every_20_ms", std::chrono::milliseconds(20)}}};
  Wall wall;
  measureDigest(wall.picture(), report);
  for (int round = 0; round < options.rounds; ++round) {
    note(fmt::format("round {} of {}", round + 1, options.rounds));
    for (Case& c : cases) wall.run(c.every, options.seconds, c.counts);
  }
  bool good = true;
  for (const Case& c : cases) {
    const Measured late = shareOf(c.counts.late, c.counts.due, "frames");
    const Measured present = medianOf(c.counts.present_ms, "frames");
    report.text("{:<12} {:6.2f} % of {} frames late, {:.3f} ms to present one", c.name,
                100 * late.value(), c.counts.due, present.value());
    report.figure(fmt::format("{}.late", c.name), late, "1");
    report.figure(fmt::format("{}.present_ms", c.name), present, "ms");
    if (c.every > Duration::zero()) {
      const Measured check = medianOf(c.counts.check_ms, "checks");
      report.text(", {:.3f} ms a check on its thread, {} wrong", check.value(), c.counts.wrong);
      report.figure(fmt::format("{}.check_ms", c.name), check, "ms");
      good = good && c.counts.wrong == 0;
    }
    report.text("\n");
  }
  return good;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::CommandLine app("The cost of reading back what outputs show");
  merlin::bench::Options options;
  app.option("--seconds", options.seconds, "Length of each run, in seconds").range(6.0, 3600.0);
  app.option("--rounds", options.rounds, "Runs of each kind").range(1, 1000);
  return app.run("checks", argc, argv, [&](merlin::bench::Report& report) {
    return merlin::bench::measure(options, report);
  });
}
