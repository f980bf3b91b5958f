// What the wall decides for its outputs before it opens them.
#include "daemon/wall/corrected_outputs.h"

#include <gtest/gtest.h>

namespace merlin::wall {
namespace {

using render::frame::RenderSettings;
using render::frame::ScanOutMode;
using render::gl::RendererInfo;

TEST(CorrectedOutputs, OnlyAGpuDrawsIntoDisplaysMemoryAndOnlyIfTheSettingsLetIt) {
  const RendererInfo gpu{.name = "a GPU", .software = false}, cpu{.name = "llvmpipe"};
  const RenderSettings automatic{}, copied{.scan_out = ScanOutMode::kCopied};
  EXPECT_TRUE(drawsIntoDisplays(automatic, gpu));
  EXPECT_FALSE(drawsIntoDisplays(copied, gpu));
  EXPECT_FALSE(drawsIntoDisplays(automatic, cpu));
  EXPECT_FALSE(drawsIntoDisplays(copied, cpu));
}

}  // namespace
}  // namespace merlin::wall
