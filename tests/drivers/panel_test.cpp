// The wall's control panel: the projectors' delays, the lamp, the button, and a GPIO chip that is
// unplugged and plugged in.
#include "drivers/gpio/panel.h"

#include <map>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "drivers/gpio/panel_loop.h"
#include "tests/support/fake_clock.h"
#include "tests/support/recording_sink.h"

namespace merlin::gpio {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const GpioSettings kSettings{.chip = "gpiochip0",
                             .projector_line = 0,
                             .video_line = 1,
                             .lamp_line = 2,
                             .button_line = 3,
                             .warm_up_s = 30,
                             .cool_down_s = 90,
                             .interlock_s = 5,
                             .debounce_s = 0.02};

struct Bench {
  test::FakeClock clock;
  Panel panel{kSettings, clock.now()};
  bool pass(Duration time, bool pressed = false) {
    clock.advance(time);
    return panel.step(pressed, clock.now());
  }
  std::uint32_t power() { return panel.sample(clock.now()).power; }
};

TEST(Panel, TheLampWarnsWhateverItWasSwitchedTo) {
  Bench b;
  ASSERT_TRUE(b.panel.execute("lamp_on", b.clock.now()));
  const auto changes = [&] {  // changes of the lamp in one second
    int count = 0;
    bool lit = b.panel.outputs(b.clock.now()).lamp;
    for (int i = 0; i < 100; ++i) {
      b.pass(milliseconds(10));
      if (std::exchange(lit, b.panel.outputs(b.clock.now()).lamp) != lit) ++count;
    }
    return count;
  };
  EXPECT_EQ(changes(), 0);
  b.panel.warn(true, b.clock.now());
  EXPECT_EQ(b.panel.sample(b.clock.now()).lamp, GpioSample::kLampFast);
  EXPECT_EQ(changes(), 8);
  EXPECT_NE(b.panel.nextDue(b.clock.now()), Timestamp::max());
  ASSERT_TRUE(b.panel.execute("lamp_off", b.clock.now()));
  EXPECT_EQ(changes(), 8) << "it is not switched off while something is wrong";
  const auto counter = b.panel.sample(b.clock.now()).counter;
  b.panel.warn(true, b.clock.now());
  EXPECT_EQ(b.panel.sample(b.clock.now()).counter, counter) << "nothing changed";
  b.panel.warn(false, b.clock.now());
  EXPECT_EQ(b.panel.sample(b.clock.now()).lamp, GpioSample::kLampOff);
  EXPECT_EQ(changes(), 0);
}

TEST(Panel, ProjectorsWarmUpAndCoolDown) {
  Bench b;
  b.pass(seconds(6));
  ASSERT_TRUE(b.panel.execute("projector_on", b.clock.now()));
  EXPECT_TRUE(b.panel.outputs(b.clock.now()).projector);
  EXPECT_EQ(b.power(), GpioSample::kWarming);
  b.pass(milliseconds(29'999));
  EXPECT_EQ(b.power(), GpioSample::kWarming);
  b.pass(milliseconds(1));
  EXPECT_EQ(b.power(), GpioSample::kOn);
  ASSERT_TRUE(b.panel.execute("projector_off", b.clock.now()));
  EXPECT_FALSE(b.panel.outputs(b.clock.now()).projector);
  EXPECT_EQ(b.power(), GpioSample::kCooling);
  b.pass(seconds(60));
  const auto refused = b.panel.execute("projector_on", b.clock.now());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kBusy);
  EXPECT_EQ(refused.error().what, "the projectors cool down: wait 30 s");
  b.pass(seconds(30));
  EXPECT_EQ(b.power(), GpioSample::kOff);
  EXPECT_TRUE(b.panel.execute("projector_on", b.clock.now()));
}

TEST(Panel, SwitchesNoFasterThanTheInterlock) {
  Bench b;
  const auto early = b.panel.execute("projector_on", b.clock.now());
  ASSERT_FALSE(early) << "whether they were on a moment ago is not known";
  EXPECT_EQ(early.error().what, "the projectors were just switched: wait 5 s");
  b.pass(seconds(5));
  ASSERT_TRUE(b.panel.execute("projector_on", b.clock.now()));
  ASSERT_TRUE(b.panel.execute("projector_on", b.clock.now())) << "they are on: nothing to do";
  b.pass(seconds(4));
  EXPECT_FALSE(b.panel.execute("projector_off", b.clock.now()));
  EXPECT_FLOAT_EQ(b.panel.sample(b.clock.now()).wait_s, 1);
}

TEST(Panel, TheLampBlinksSlowlyAndFast) {
  Bench b;
  const auto lit = [&](const char* command, Duration step, int steps) {
    EXPECT_TRUE(b.panel.execute(command, b.clock.now()));
    int changes = 0;
    bool last = b.panel.outputs(b.clock.now()).lamp;
    for (int i = 0; i < steps; ++i) {
      b.clock.advance(step);
      const bool now = b.panel.outputs(b.clock.now()).lamp;
      changes += now != last;
      last = now;
    }
    return changes;
  };
  EXPECT_EQ(lit("lamp_off", milliseconds(10), 1000), 0);
  EXPECT_FALSE(b.panel.outputs(b.clock.now()).lamp);
  EXPECT_EQ(lit("lamp_slow", milliseconds(10), 1000), 10);  // ten seconds
  EXPECT_EQ(lit("lamp_fast", milliseconds(5), 2000), 80);
  lit("lamp_on", milliseconds(10), 1);
  EXPECT_TRUE(b.panel.outputs(b.clock.now()).lamp);
}

TEST(Panel, ABouncingButtonIsOnePress) {
  Bench b;
  int presses = 0;
  for (const bool level : {true, false, true, false, true})
    presses += b.pass(milliseconds(3), level);
  EXPECT_EQ(presses, 0);
  for (int i = 0; i < 20; ++i) presses += b.pass(milliseconds(3), true);
  EXPECT_EQ(presses, 1);
  for (const bool level : {false, true, false, true, false})
    presses += b.pass(milliseconds(3), level);
  for (int i = 0; i < 20; ++i) presses += b.pass(milliseconds(3), false);
  EXPECT_EQ(presses, 1);
  for (int i = 0; i < 20; ++i) presses += b.pass(milliseconds(3), true);
  EXPECT_EQ(presses, 2);
  EXPECT_EQ(b.panel.sample(b.clock.now()).presses, 2u);
}

TEST(Panel, SaysWhenSomethingChangesByItself) {
  Bench b;
  EXPECT_EQ(b.panel.nextDue(b.clock.now()), Timestamp::max());
  b.pass(seconds(5));
  ASSERT_TRUE(b.panel.execute("projector_on", b.clock.now()));
  EXPECT_EQ(b.panel.nextDue(b.clock.now()) - b.clock.now(), seconds(30));
  b.pass(milliseconds(1), true);
  EXPECT_EQ(b.panel.nextDue(b.clock.now()) - b.clock.now(), milliseconds(20));
}

TEST(Panel, RefusesWhatItDoesNotKnow) {
  Bench b;
  EXPECT_EQ(b.panel.execute("explode", b.clock.now()).error().code, Errc::kInvalidArgument);
}

// A GPIO chip that a test can unplug.
struct FakeChip {
  bool there = true;
  bool button = false;
  std::map<int, bool> level;
  int opened = 0;
};

struct FakeLines final : GpioLines {
  FakeLines(FakeChip& c, test::FakeClock& k) : chip(c), clock(k) {}
  Result<Ok> write(int line, bool high) override {
    if (!chip.there) return gone();
    chip.level[line] = high;
    return Ok{};
  }
  Result<bool> read(int) override {
    if (!chip.there) return gone();
    return chip.button;
  }
  Result<Ok> wait(Duration timeout) override {
    clock.advance(std::max<Duration>(timeout, milliseconds(1)));
    return Ok{};
  }
  static Error gone() { return {Errc::kIo, "gpiochip0: No such device"}; }
  FakeChip& chip;
  test::FakeClock& clock;
};

TEST(PanelLoop, WritesLinesAndKeepsThemOverALostChip) {
  test::FakeClock clock;
  FakeChip chip;
  test::RecordingHealth health;
  std::stop_source stop;
  int pressed = 0;
  int rounds = 0;
  PanelLoop* self = nullptr;
  GpioSample newest{};
  const auto each = [&](const GpioSample& sample) {
    newest = sample;
    ++rounds;
    if (rounds == 200) {
      EXPECT_TRUE(self->execute("video_b"));
    }
    if (rounds == 210) chip.there = false;
    chip.button = rounds > 230 && rounds < 240;
    if (rounds == 300) stop.request_stop();
  };
  PanelLoop loop(
      kSettings,
      [&]() -> Result<std::unique_ptr<GpioLines>> {
        ++chip.opened;
        if (chip.opened == 2) {
          EXPECT_FALSE(self->execute("video_a")) << "the chip is gone";
          chip.there = false;
          return Error{Errc::kNotFound, "gpiochip0: open: No such file or directory"};
        }
        chip.there = true;
        chip.level.clear();
        return std::unique_ptr<GpioLines>(std::make_unique<FakeLines>(chip, clock));
      },
      each, health, clock, [&] { ++pressed; });
  self = &loop;
  loop.run(stop.get_token());
  EXPECT_EQ(chip.opened, 3);
  EXPECT_TRUE(chip.level.at(1)) << "video B, as it was before the chip was lost";
  EXPECT_EQ(pressed, 1);
  EXPECT_EQ(newest.presses, 1u);
  std::vector<HealthState> states;
  for (const DeviceHealth& h : health.all) {
    if (states.empty() || states.back() != h.state) states.push_back(h.state);
  }
  EXPECT_EQ(states, (std::vector{HealthState::kOk, HealthState::kFailed, HealthState::kAbsent,
                                 HealthState::kOk, HealthState::kAbsent}));
}

}  // namespace
}  // namespace merlin::gpio
