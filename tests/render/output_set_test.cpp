// The outputs of a wall together, and the stages before them, with fakes for single outputs.
#include "render/out/output_set.h"

#include <gtest/gtest.h>

#include "render/frame/delivery.h"
#include "render/out/settings.h"

namespace merlin::render {
namespace {

using std::chrono::milliseconds;

// Shows each frame `delay` after it was finished, or fails.
struct FakeOutput final : Output {
  Result<std::optional<Timestamp>> present(const Signal& signal, const FrameInfo& info) override {
    seen.assign(signal.pixels.begin(), signal.pixels.end());
    if (!fault.empty()) return Error{Errc::kIo, fault};
    if (leaves_out) return std::optional<Timestamp>();
    return std::optional(info.finished + delay);
  }
  Result<std::string> mend() override {
    if (!fault.empty()) return Error{Errc::kIo, fault};
    return mended;
  }
  Duration delay{};
  bool leaves_out = false;
  std::string fault, mended;
  std::vector<std::uint8_t> seen;
};

class OutputSetTest : public testing::Test {
 protected:
  OutputSetTest() {
    std::vector<NamedOutput> outputs;
    for (const char* name : {"first", "second"}) {
      auto output = std::make_unique<FakeOutput>();
      fakes_.push_back(output.get());
      outputs.push_back({name, "fake", std::move(output)});
    }
    set_ = std::make_unique<OutputSet>(std::move(outputs));
  }
  void present(Timestamp finished, std::optional<Timestamp> deadline) {
    for (std::size_t i = 0; i < set_->size(); ++i)
      set_->present(i, {1, 1, pixels_}, {1, finished, 10, false}, deadline);
  }

  std::vector<std::uint8_t> pixels_ = {1, 2, 3, 4};
  std::vector<FakeOutput*> fakes_;
  std::unique_ptr<OutputSet> set_;
};

TEST_F(OutputSetTest, EachIsLateByItsOwnTimes) {
  fakes_[1]->delay = milliseconds(5);
  Timestamp now{};
  for (int i = 0; i < 60; ++i) {
    now += milliseconds(20);
    present(now, now + milliseconds(i < 15 ? 4 : 6));
  }
  EXPECT_EQ(set_->state(0).late, 0u);
  EXPECT_EQ(set_->state(1).late, 15u);
  EXPECT_DOUBLE_EQ(set_->state(1).lateShare(), 0.25);
  EXPECT_NEAR(set_->shownHz(0, now), 50, 1);
  EXPECT_NEAR(set_->shownHz(1, now + milliseconds(5)), 50, 1);
  EXPECT_EQ(set_->shownHz(0, now + milliseconds(2000)), 0);
}

TEST_F(OutputSetTest, AFrameWithoutADeadlineIsNotLateAndOneLeftOutIsNotShown) {
  fakes_[0]->leaves_out = true;
  fakes_[1]->delay = milliseconds(500);
  present(Timestamp{milliseconds(1)}, std::nullopt);
  EXPECT_EQ(set_->state(0).frames, 0u);
  EXPECT_EQ(set_->state(0).fault, "");
  EXPECT_EQ(set_->state(1).frames, 1u);
  EXPECT_EQ(set_->state(1).due, 0u);
}

TEST_F(OutputSetTest, OneThatFailsTakesNothingWithItAndItsFaultEnds) {
  fakes_[0]->fault = "the disk is full";
  present(Timestamp{milliseconds(1)}, std::nullopt);
  EXPECT_EQ(set_->state(0).fault, "the disk is full");
  EXPECT_EQ(set_->state(0).frames, 0u);
  EXPECT_EQ(set_->state(1).frames, 1u);
  fakes_[0]->fault.clear();
  present(Timestamp{milliseconds(2)}, std::nullopt);
  EXPECT_EQ(set_->state(0).fault, "");
  EXPECT_EQ(set_->state(0).frames, 1u);
}

TEST_F(OutputSetTest, MendingAsksEach) {
  EXPECT_EQ(*set_->mend(), "");
  fakes_[0]->mended = "a";
  fakes_[1]->mended = "b";
  EXPECT_EQ(*set_->mend(), "a; b");
  fakes_[0]->fault = "gone";
  EXPECT_EQ(set_->mend().error().what, "gone");
}

// Draws its number into the first byte.
struct FakeOverlay final : Overlay {
  explicit FakeOverlay(std::uint8_t number) : number_(number) {}
  bool hasChanged() const override { return changed; }
  void draw(std::span<std::uint8_t> canvas) override { was_ = std::exchange(canvas[0], number_); }
  void erase(std::span<std::uint8_t> canvas) override { canvas[0] = was_; }
  bool changed = false;

 private:
  std::uint8_t number_, was_ = 0;
};

struct Inverted final : Correction {
  Signal apply(const Signal& canvas) override {
    pixels.assign(canvas.pixels.begin(), canvas.pixels.end());
    for (std::uint8_t& p : pixels) p = static_cast<std::uint8_t>(255 - p);
    return {canvas.width, canvas.height, pixels};
  }
  std::vector<std::uint8_t> pixels;
};

// The first output has a correction, the second is sent the canvas itself.
TEST_F(OutputSetTest, OverlaysComeBeforeEachOutputsOwnCorrectionAndAreTakenOutAgain) {
  FakeOverlay below(70), above(80);
  std::vector<std::unique_ptr<Correction>> corrections;
  corrections.push_back(std::make_unique<Inverted>());
  TilePlan plan;
  plan.frame_width = plan.frame_height = 1;
  Delivery delivery(plan, *set_, {&below, &above}, std::move(corrections));
  delivery.show(pixels_, {}, std::nullopt);
  EXPECT_EQ(fakes_[0]->seen, (std::vector<std::uint8_t>{175, 253, 252, 251}));
  EXPECT_EQ(fakes_[1]->seen, (std::vector<std::uint8_t>{80, 2, 3, 4}));
  EXPECT_EQ(pixels_, (std::vector<std::uint8_t>{1, 2, 3, 4}));
  EXPECT_FALSE(delivery.overlaysHaveChanged());
  above.changed = true;
  EXPECT_TRUE(delivery.overlaysHaveChanged());
}

std::string faultOf(const std::vector<OutputSettings>& outputs) {
  const SettingFaults faults = validate(outputs, {});
  return faults.empty() ? "" : faults[0].pointer + " " + faults[0].what;
}

TEST(OutputSettings, AreCheckedTogether) {
  const OutputSettings shared, png{OutputKind::kPng, "", "a.png", 60};
  EXPECT_EQ(faultOf({shared, png}), "");
  EXPECT_EQ(faultOf({}), " is an empty list; a wall has at least one output");
  EXPECT_EQ(faultOf(std::vector<OutputSettings>(9, png)), " has 9 outputs; a wall has at most 8");
  EXPECT_EQ(faultOf({png, png}), "/1 is the second output named \"png\"; give it a \"name\"");
  EXPECT_EQ(faultOf({png, {OutputKind::kPng, "b", "b.png", 60}}), "");
  EXPECT_EQ(faultOf({shared, {OutputKind::kSharedMemory, "b", "", 60}}),
            "/1 is the second output of kind shared_memory; a wall has at most one");
  EXPECT_EQ(faultOf({{OutputKind::kPng, "", "", 60}}),
            "/0 has no path; an output of kind png needs the name of its file");
  EXPECT_EQ(faultOf({{OutputKind::kSharedMemory, "", "a.png", 60}}),
            "/0/path is not a setting of kind shared_memory");
  EXPECT_EQ(faultOf({{OutputKind::kSharedMemory, std::string(24, 'n'), "", 60}}),
            "/0/name has 24 characters; at most 23 are allowed");
}

}  // namespace
}  // namespace merlin::render
