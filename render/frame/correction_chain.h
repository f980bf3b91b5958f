// CorrectionChain: applies several corrections in turn, each to the signal of the one before.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "render/frame/correction.h"

namespace merlin::render::frame {

// Thread-bound to the wall's thread.
class CorrectionChain final : public Correction {
 public:
  explicit CorrectionChain(std::vector<std::unique_ptr<Correction>> links)
      : links_(std::move(links)) {}

  out::Signal apply(const out::Signal& canvas) override {
    out::Signal signal = canvas;
    for (const auto& link : links_) signal = link->apply(signal);
    return signal;
  }
  bool canDraw() override { return !links_.empty() && links_.back()->canDraw(); }
  out::Signal draw(const out::Signal& canvas, std::span<const out::DrawPlace> places) override {
    out::Signal signal = canvas;
    for (const auto& link : links_)
      signal = link == links_.back() ? link->draw(signal, places) : link->apply(signal);
    return signal;
  }
  bool hasChanged() const override {
    return std::ranges::any_of(links_, [](const auto& link) { return link->hasChanged(); });
  }

 private:
  std::vector<std::unique_ptr<Correction>> links_;
};

}  // namespace merlin::render::frame
