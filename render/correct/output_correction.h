// OutputCorrection: turns a picture into the signal that makes one output's screen show it as
// intended.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "daemon/base/blocks.h"
#include "render/correct/correct_pixels.h"
#include "render/correct/correction_map.h"
#include "render/correct/correction_pass.h"
#include "render/frame/correction.h"

namespace merlin::render::correct {

// Thread-bound to the wall's thread; uses the threads of that thread's team.
class OutputCorrection final : public frame::Correction {
 public:
  // Memory: 16 bytes per pixel. `pass` computes the signals that it can, and the CPU the others;
  // it must outlive this; null: the CPU computes all.
  OutputCorrection(CorrectionMap map, Threads threads, CorrectionPass* pass = nullptr);

  // Computes the signal, in one pass over the output's pixels. REQUIRES: the picture has the map's
  // source size.
  out::Signal apply(const out::Signal& picture) override;

  bool canDraw() override { return pass_ && pass_->canDraw(); }
  out::Signal draw(const out::Signal& picture, std::span<const out::DrawPlace> places) override;

  const CorrectionMap& map() const noexcept { return *map_; }

 private:
  std::shared_ptr<const CorrectionMap> map_;  // shared, so that `pass_` sees when it is unused
  Threads threads_;
  CorrectionPass* pass_;
  CorrectRows correct_ = rowCorrector();
  std::vector<std::uint8_t> pixels_;
};

}  // namespace merlin::render::correct
