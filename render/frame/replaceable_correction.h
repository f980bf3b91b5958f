// ReplaceableCorrection: an output's correction that can be replaced while the wall runs. While
// there is none (null), the signal is the canvas itself.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <utility>

#include "render/frame/correction.h"

namespace merlin::render::frame {

// replace() is called by one other thread at a time, all other functions by the wall's thread.
class ReplaceableCorrection final : public Correction {
 public:
  explicit ReplaceableCorrection(std::unique_ptr<Correction> first = nullptr)
      : current_(std::move(first)) {}

  // apply() uses `next` from its next call on. The correction that it replaces is destroyed in this
  // call or in the next replace(), never on the wall's thread. Returns at once.
  void replace(std::unique_ptr<Correction> next) {
    std::unique_ptr<Correction> old, skipped;
    const std::lock_guard lock(mutex_);
    old = std::move(retired_);
    skipped = std::exchange(next_, std::move(next));
    waiting_ = true;
  }

  bool hasChanged() const override { return waiting_ || (current_ && current_->hasChanged()); }

  // Without a correction this costs nothing. Never waits: if replace() is running at the same time,
  // the next frame uses the new correction.
  out::Signal apply(const out::Signal& canvas) override {
    if (waiting_) take();
    return current_ ? current_->apply(canvas) : canvas;
  }

  // Takes the newest correction, which the draw() that follows then uses too.
  bool canDraw() override {
    if (waiting_) take();
    return current_ && current_->canDraw();
  }
  out::Signal draw(const out::Signal& canvas, std::span<const out::DrawPlace> places) override {
    return current_->draw(canvas, places);
  }

 private:
  void take() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || !waiting_) return;
    retired_ = std::exchange(current_, std::move(next_));
    waiting_ = false;
  }

  std::mutex mutex_;  // guards next_ and retired_
  std::unique_ptr<Correction> current_, next_, retired_;
  std::atomic<bool> waiting_{false};
};

}  // namespace merlin::render::frame
