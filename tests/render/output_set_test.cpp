// A wall's outputs, which are fakes here, together with the stages before them.
#include "render/out/output_set.h"

#include <gtest/gtest.h>

#include "render/frame/correction_chain.h"
#include "render/frame/delivery.h"
#include "render/frame/replaceable_correction.h"
#include "render/out/settings.h"

namespace merlin::render {
namespace {

using std::chrono::milliseconds;

// An output that shows each frame `delay` after the frame was finished, or fails, or leaves the
// frame out.
struct FakeOutput final : out::Output {
  Result<std::optional<Timestamp>> present(const out::Signal& signal,
                                           const out::FrameInfo& info) override {
    seen.assign(signal.pixels.begin(), signal.pixels.end());
    was_drawn = signal.drawn;
    if (!fault.empty()) return Error{Errc::kIo, fault};
    if (leaves_out) return std::optional<Timestamp>();
    return std::optional(info.finished + delay);
  }
  bool mayTake(const out::FrameInfo&) const override { return !leaves_out; }
  Result<std::string> mend() override {
    ++times_mended;
    if (!fault.empty()) return Error{Errc::kIo, fault};
    return mended;
  }
  std::vector<out::DrawPlace> beginDrawing() override {
    ++times_begun;
    return places;
  }
  std::string copyReason() const override { return copy_reason; }
  std::vector<out::DrawPlace> places;
  std::string copy_reason;
  int times_begun = 0;
  bool was_drawn = false;
  bool wantsFrame(Timestamp) const override { return wants_frame; }
  std::optional<out::Vblank> vblank() const override { return last_blank; }
  bool wants_frame = false;
  std::optional<out::Vblank> last_blank;
  Duration delay{};
  bool leaves_out = false;
  std::optional<std::string> faultNow() const override { return fault_now; }
  std::string fault, mended;
  std::optional<std::string> fault_now;
  int times_mended = 0;
  std::vector<std::uint8_t> seen;
};

class OutputSetTest : public testing::Test {
 protected:
  OutputSetTest() {
    std::vector<out::NamedOutput> outputs;
    for (const char* name : {"first", "second"}) {
      auto output = std::make_unique<FakeOutput>();
      fakes_.push_back(output.get());
      outputs.push_back({name, "fake", std::move(output)});
    }
    set_ = std::make_unique<out::OutputSet>(std::move(outputs));
  }
  void present(Timestamp finished, std::optional<Timestamp> deadline) {
    for (std::size_t i = 0; i < set_->size(); ++i)
      set_->present(i, {1, 1, pixels_}, {1, finished, 10, false}, deadline);
  }

  std::vector<std::uint8_t> pixels_ = {1, 2, 3, 4};
  std::vector<FakeOutput*> fakes_;
  std::unique_ptr<out::OutputSet> set_;
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

TEST_F(OutputSetTest, WhatAnOutputLearnsOnItsOwnReplacesWhatItsLastFrameToldOfIt) {
  fakes_[0]->fault = "the disk is full";
  present(Timestamp{milliseconds(1)}, std::nullopt);
  EXPECT_EQ(set_->faultNow(0), "the disk is full");
  EXPECT_EQ(set_->faultNow(1), "");
  fakes_[0]->fault_now = "";
  fakes_[1]->fault_now = "unplugged";
  EXPECT_EQ(set_->faultNow(0), "");
  EXPECT_EQ(set_->faultNow(1), "unplugged");
}

TEST_F(OutputSetTest, MendingAsksEach) {
  EXPECT_EQ(*set_->mend(), "");
  fakes_[0]->mended = "a";
  fakes_[1]->mended = "b";
  EXPECT_EQ(*set_->mend(), "a; b");
}

TEST_F(OutputSetTest, OneThatCannotBeMendedDoesNotKeepTheOthersFromBeingMended) {
  fakes_[0]->fault = "gone";
  fakes_[1]->mended = "b";
  EXPECT_EQ(set_->mend().error().what, "gone; b");
  EXPECT_EQ(fakes_[1]->times_mended, 1);
  fakes_[1]->fault = "gone as well";
  EXPECT_EQ(set_->mend().error().what, "gone; gone as well");
}

// An overlay that writes its number into the first byte of the canvas.
struct FakeOverlay final : frame::Overlay {
  explicit FakeOverlay(std::uint8_t number) : number_(number) {}
  bool hasChanged() const override { return changed; }
  void draw(std::span<std::uint8_t> canvas) override { was_ = std::exchange(canvas[0], number_); }
  void erase(std::span<std::uint8_t> canvas) override { canvas[0] = was_; }
  bool changed = false;

 private:
  std::uint8_t number_, was_ = 0;
};

struct Inverted final : frame::Correction {
  out::Signal apply(const out::Signal& canvas) override {
    ++applied;
    pixels.assign(canvas.pixels.begin(), canvas.pixels.end());
    for (std::uint8_t& p : pixels) p = static_cast<std::uint8_t>(255 - p);
    return {canvas.width, canvas.height, pixels};
  }
  std::vector<std::uint8_t> pixels;
  int applied = 0;
};

// The first output has a correction; the second one gets the canvas unchanged.
TEST_F(OutputSetTest, OverlaysComeBeforeEachOutputsOwnCorrectionAndAreTakenOutAgain) {
  FakeOverlay below(70), above(80);
  std::vector<std::unique_ptr<frame::Correction>> corrections;
  corrections.push_back(std::make_unique<Inverted>());
  tiles::TilePlan plan;
  plan.frame_width = plan.frame_height = 1;
  frame::Delivery delivery(plan, *set_, {&below, &above}, std::move(corrections));
  delivery.show(pixels_, {}, std::nullopt);
  EXPECT_EQ(fakes_[0]->seen, (std::vector<std::uint8_t>{175, 253, 252, 251}));
  EXPECT_EQ(fakes_[1]->seen, (std::vector<std::uint8_t>{80, 2, 3, 4}));
  EXPECT_EQ(pixels_, (std::vector<std::uint8_t>{1, 2, 3, 4}));
  EXPECT_FALSE(delivery.hasChanged({}));
  above.changed = true;
  EXPECT_TRUE(delivery.hasChanged({}));
}

TEST_F(OutputSetTest, AFrameThatAnOutputLeavesOutIsNotCorrectedForIt) {
  auto correction = std::make_unique<Inverted>();
  const Inverted& inverted = *correction;
  std::vector<std::unique_ptr<frame::Correction>> corrections;
  corrections.push_back(std::move(correction));
  tiles::TilePlan plan;
  plan.frame_width = plan.frame_height = 1;
  frame::Delivery delivery(plan, *set_, {}, std::move(corrections));
  fakes_[0]->leaves_out = true;
  delivery.show(pixels_, {}, std::nullopt);
  EXPECT_EQ(inverted.applied, 0);
  fakes_[0]->leaves_out = false;
  delivery.show(pixels_, {}, std::nullopt);
  EXPECT_EQ(inverted.applied, 1);
}

TEST_F(OutputSetTest, AnOutputThatWantsAFrameGetsItWhileNothingMoves) {
  const tiles::TilePlan plan;
  const frame::Delivery delivery(plan, *set_);
  EXPECT_FALSE(delivery.hasChanged({}));
  fakes_[1]->wants_frame = true;
  EXPECT_TRUE(delivery.hasChanged({}));
}

TEST_F(OutputSetTest, TheFirstDisplayThatTellsItsBlanksLeads) {
  EXPECT_FALSE(set_->vblank());
  fakes_[1]->last_blank = out::Vblank{Timestamp(milliseconds(3)), milliseconds(16)};
  EXPECT_EQ(set_->vblank()->last, Timestamp(milliseconds(3)));
  fakes_[0]->last_blank = out::Vblank{Timestamp(milliseconds(4)), milliseconds(20)};
  EXPECT_EQ(set_->vblank()->period, milliseconds(20));
}

struct Delivered : OutputSetTest {
  // Makes the delivery; `correction` belongs to the first output.
  void deliverWith(std::unique_ptr<frame::Correction> correction,
                   frame::SignalWatcher* watcher = nullptr) {
    std::vector<std::unique_ptr<frame::Correction>> corrections;
    corrections.push_back(std::move(correction));
    plan_.frame_width = plan_.frame_height = 1;
    delivery_ = std::make_unique<frame::Delivery>(plan_, *set_, std::vector<frame::Overlay*>{},
                                                  std::move(corrections), watcher);
  }
  std::vector<std::uint8_t> shown() {
    delivery_->show(pixels_, {}, std::nullopt);
    return fakes_[0]->seen;
  }

  tiles::TilePlan plan_;
  std::unique_ptr<frame::Delivery> delivery_;
  const std::vector<std::uint8_t> meant_ = {1, 2, 3, 4}, inverted_ = {254, 253, 252, 251};
};

TEST_F(Delivered, AnotherCorrectionTakesItsPlaceFromTheNextFrameOn) {
  auto made = std::make_unique<frame::ReplaceableCorrection>();
  frame::ReplaceableCorrection& replaceable = *made;
  deliverWith(std::move(made));
  EXPECT_EQ(shown(), meant_);
  EXPECT_FALSE(delivery_->hasChanged({}));
  replaceable.replace(std::make_unique<Inverted>());
  EXPECT_TRUE(delivery_->hasChanged({})) << "a still wall has to show it";
  EXPECT_EQ(shown(), inverted_);
  EXPECT_FALSE(delivery_->hasChanged({}));
  replaceable.replace(nullptr);
  EXPECT_EQ(shown(), meant_);
}

// A correction that draws into the memory that the output names, if `can_draw` is true.
struct Drawn final : frame::Correction {
  explicit Drawn(bool can) : can_draw(can) {}
  out::Signal apply(const out::Signal& canvas) override {
    ++applied;
    return canvas;
  }
  bool canDraw() override { return can_draw; }
  out::Signal draw(const out::Signal& canvas, std::span<const out::DrawPlace> places) override {
    ++drawn;
    last_x = places.front().x;
    return {canvas.width, canvas.height, canvas.pixels, true};
  }
  bool can_draw;
  int applied = 0, drawn = 0, last_x = 0;
};

struct WatcherOfFirst final : frame::SignalWatcher {
  bool wants(std::size_t i) const override { return i == 0 && asked; }
  void see(std::size_t, const out::Signal& signal, const out::FrameInfo&) override {
    seen_drawn = signal.drawn;
    ++seen;
  }
  bool asked = false, seen_drawn = false;
  int seen = 0;
};

TEST_F(Delivered, ACorrectionThatCanDrawDrawsWhereTheOutputShowsIt) {
  auto made = std::make_unique<Drawn>(true);
  const Drawn& correction = *made;
  WatcherOfFirst watcher;
  deliverWith(std::move(made), &watcher);
  shown();
  EXPECT_EQ(correction.applied, 1) << "an output without places is copied to";
  EXPECT_FALSE(fakes_[0]->was_drawn);
  fakes_[0]->places = {{nullptr, 5, 6}};
  shown();
  EXPECT_EQ(correction.drawn, 1);
  EXPECT_EQ(correction.last_x, 5);
  EXPECT_TRUE(fakes_[0]->was_drawn);
  EXPECT_EQ(correction.applied, 1);

  watcher.asked = true;  // merlin snapshot --output needs the whole signal in memory
  shown();
  EXPECT_EQ(watcher.seen, 1);
  EXPECT_FALSE(watcher.seen_drawn || fakes_[0]->was_drawn);
  EXPECT_EQ(correction.applied, 2);
  EXPECT_EQ(fakes_[0]->times_begun, 2) << "nothing is begun for a signal that is copied";
  watcher.asked = false;
  shown();
  EXPECT_TRUE(fakes_[0]->was_drawn);
}

TEST_F(Delivered, WhetherSignalsAreDrawnIsSaidOfTheLastOnes) {
  deliverWith(std::make_unique<Drawn>(true));
  EXPECT_FALSE(set_->draws());
  fakes_[0]->places.resize(1);
  shown();
  EXPECT_TRUE(set_->draws()) << "although the second output is copied to";
  fakes_[0]->leaves_out = true;
  shown();
  EXPECT_TRUE(set_->draws());
  fakes_[0]->leaves_out = false;
  fakes_[0]->places.clear();
  shown();
  EXPECT_FALSE(set_->draws());
}

TEST_F(OutputSetTest, TheFirstReasonWhySignalsAreCopiedIsTold) {
  EXPECT_EQ(set_->copyReason(), "");
  fakes_[1]->copy_reason = "b";
  EXPECT_EQ(set_->copyReason(), "b");
  fakes_[0]->copy_reason = "a";
  EXPECT_EQ(set_->copyReason(), "a");
}

// A watcher in another thread may stop wanting a signal while the signal is made.
struct WatcherThatIsAskedOnce final : frame::SignalWatcher {
  bool wants(std::size_t i) const override { return i == 0 && times_asked++ == 0; }
  void see(std::size_t, const out::Signal& signal, const out::FrameInfo&) override {
    seen_drawn = signal.drawn;
  }
  mutable int times_asked = 0;
  std::optional<bool> seen_drawn;
};

TEST_F(Delivered, WhoeverSeesASignalSeesAllOfItAlsoIfNobodyWantsItAnyMore) {
  WatcherThatIsAskedOnce watcher;
  deliverWith(std::make_unique<Drawn>(true), &watcher);
  fakes_[0]->places.resize(1);
  shown();
  EXPECT_EQ(watcher.seen_drawn, false);
  EXPECT_EQ(watcher.times_asked, 1);
}

TEST_F(Delivered, NothingIsBegunForACorrectionThatCannotDrawOrAFrameThatIsLeftOut) {
  auto made = std::make_unique<Drawn>(false);
  Drawn& correction = *made;
  deliverWith(std::move(made));
  fakes_[0]->places.resize(1);
  shown();
  EXPECT_EQ(correction.applied, 1);
  correction.can_draw = true;
  fakes_[0]->leaves_out = true;
  shown();
  EXPECT_EQ(correction.drawn, 0);
  EXPECT_EQ(fakes_[0]->times_begun, 0);
}

// In a chain of corrections, the last link makes the signal.
TEST_F(Delivered, TheLastOfSeveralCorrectionsDraws) {
  auto last = std::make_unique<Drawn>(true);
  auto first = std::make_unique<Inverted>();
  const Drawn& drawn = *last;
  const Inverted& inverted = *first;
  std::vector<std::unique_ptr<frame::Correction>> links;
  links.push_back(std::move(first));
  links.push_back(std::move(last));
  deliverWith(std::make_unique<frame::CorrectionChain>(std::move(links)));
  fakes_[0]->places.resize(1);
  EXPECT_EQ(shown(), inverted_);
  EXPECT_EQ(inverted.applied, 1);
  EXPECT_EQ(drawn.drawn, 1);
  EXPECT_TRUE(fakes_[0]->was_drawn);
}

TEST_F(Delivered, AReplacementIsAskedWhetherItCanDrawBeforeAnythingIsBegun) {
  auto made = std::make_unique<frame::ReplaceableCorrection>(std::make_unique<Drawn>(true));
  frame::ReplaceableCorrection& replaceable = *made;
  deliverWith(std::move(made));
  fakes_[0]->places.resize(1);
  shown();
  EXPECT_TRUE(fakes_[0]->was_drawn);
  replaceable.replace(std::make_unique<Inverted>());
  EXPECT_EQ(shown(), inverted_);
  EXPECT_FALSE(fakes_[0]->was_drawn);
  EXPECT_EQ(fakes_[0]->times_begun, 1);
  replaceable.replace(nullptr);
  EXPECT_EQ(shown(), meant_);
  replaceable.replace(std::make_unique<Drawn>(true));
  shown();
  EXPECT_TRUE(fakes_[0]->was_drawn) << "and drawing goes on";
}

// Counts how many objects exist, and notes where one is destroyed.
struct Counted final : frame::Correction {
  explicit Counted(int& alive) : alive_(alive) { ++alive_; }
  ~Counted() override { --alive_; }
  out::Signal apply(const out::Signal& canvas) override { return canvas; }
  int& alive_;
};

TEST(ReplaceableCorrection, TheOldOneIsDestroyedByTheOneWhoReplacesIt) {
  int alive = 0;
  {
    frame::ReplaceableCorrection replaceable(std::make_unique<Counted>(alive));
    replaceable.replace(std::make_unique<Counted>(alive));
    replaceable.replace(std::make_unique<Counted>(alive));
    EXPECT_EQ(alive, 2) << "one was never used";
    replaceable.apply({});
    EXPECT_EQ(alive, 2) << "not on the wall's thread";
    replaceable.replace(std::make_unique<Counted>(alive));
    EXPECT_EQ(alive, 2);
  }
  EXPECT_EQ(alive, 0);
}

TEST_F(Delivered, AChangeForAnOutputThatTakesNoFrameNowCanWait) {
  auto made = std::make_unique<frame::ReplaceableCorrection>();
  frame::ReplaceableCorrection& replaceable = *made;
  deliverWith(std::move(made));
  replaceable.replace(std::make_unique<Inverted>());
  fakes_[0]->leaves_out = true;
  EXPECT_FALSE(delivery_->hasChanged({}));
  fakes_[0]->leaves_out = false;
  EXPECT_TRUE(delivery_->hasChanged({}));
}

struct FakeWatcher final : frame::SignalWatcher {
  bool wants(std::size_t i) const override { return i == wanted; }
  void see(std::size_t, const out::Signal& signal, const out::FrameInfo&) override {
    seen.assign(signal.pixels.begin(), signal.pixels.end());
    wanted = 99;
  }
  std::size_t wanted = 99;
  std::vector<std::uint8_t> seen;
};

TEST_F(Delivered, ASignalThatSomebodyWantsIsMadeAlsoWhereTheOutputTakesNone) {
  FakeWatcher watcher;
  deliverWith(std::make_unique<Inverted>(), &watcher);
  fakes_[0]->leaves_out = true;
  EXPECT_FALSE(delivery_->hasChanged({}));
  watcher.wanted = 0;
  EXPECT_TRUE(delivery_->hasChanged({})) << "a still wall has to make it";
  shown();
  EXPECT_EQ(watcher.seen, inverted_);
  EXPECT_FALSE(delivery_->hasChanged({}));
  watcher.wanted = 1;
  EXPECT_TRUE(delivery_->hasChanged({}));
  shown();
  EXPECT_EQ(watcher.seen, meant_) << "that output has no correction";
}

std::string faultOf(const std::vector<out::OutputSettings>& outputs) {
  const SettingFaults faults = validate(outputs, {});
  return faults.empty() ? "" : faults[0].pointer + " " + faults[0].what;
}

TEST(OutputSettings, AreCheckedTogether) {
  const out::OutputSettings shared, png{out::OutputKind::kPng, "", "a.png", 60};
  EXPECT_EQ(faultOf({shared, png}), "");
  EXPECT_EQ(faultOf({}), " is an empty list; a wall has at least one output");
  EXPECT_EQ(faultOf(std::vector<out::OutputSettings>(33, png)),
            " has 33 outputs; a wall has at most 32");
  EXPECT_EQ(faultOf({png, png}), "/1 is the second output named \"png\"; give it a \"name\"");
  EXPECT_EQ(faultOf({png, {out::OutputKind::kPng, "b", "b.png", 60}}), "");
  EXPECT_EQ(faultOf({png, {out::OutputKind::kPng, "b", "a.png", 60}}),
            "/1/path is a.png, to which the output png writes already");
  out::OutputSettings display{out::OutputKind::kKms};
  display.kms.mode = "640x480@60";
  EXPECT_EQ(faultOf({display}).find("/0/kms/mode is 640x480@60, and the output's picture has"), 0U);
  display.kms.mode = "7680x4320";
  EXPECT_EQ(faultOf({display}), "");
  EXPECT_EQ(faultOf({shared, {out::OutputKind::kSharedMemory, "b", "", 60}}),
            "/1 is the second output of kind shared_memory; a wall has at most one");
  EXPECT_EQ(faultOf({{out::OutputKind::kPng, "", "", 60}}),
            "/0 has no path; an output of kind png needs the name of its file");
  EXPECT_EQ(faultOf({{out::OutputKind::kSharedMemory, "", "a.png", 60}}),
            "/0/path is not a setting of kind shared_memory");
  EXPECT_EQ(faultOf({{out::OutputKind::kSharedMemory, std::string(24, 'n'), "", 60}}),
            "/0/name has 24 characters; at most 23 are allowed");
}

}  // namespace
}  // namespace merlin::render
