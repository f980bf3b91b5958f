// The choice of a GPU, from synthetic lists and from this machine's list.
#include "render/gl/gpu_list.h"

#include <gtest/gtest.h>

#include "render/gl/gl_context.h"

namespace merlin::render {
namespace {

gl::Gpu gpuOf(const char* name, const char* node, const char* card, const char* pci) {
  gl::Gpu gpu;
  gpu.renderer = {"EGL", name, "vendor", "driver", node, pci, false};
  gpu.card = card;
  return gpu;
}

std::vector<gl::Gpu> threeGpus() {
  std::vector<gl::Gpu> gpus = {
      gpuOf("NVIDIA H100 80GB HBM3/PCIe", "/dev/dri/renderD129", "/dev/dri/card1", "0000:41:00.0"),
      gpuOf("AMD Radeon Graphics (gfx1103)", "/dev/dri/renderD128", "/dev/dri/card0",
            "0000:01:00.0"),
      gpuOf("Mesa llvmpipe", "", "", "")};
  gpus[2].renderer.software = true;
  return gpus;
}

TEST(GpuList, AGpuIsFoundByNumberNodeAddressOrPartOfItsName) {
  const auto gpus = threeGpus();
  for (const char* const wanted :
       {"1", "/dev/dri/renderD128", "/dev/dri/card0", "0000:01:00.0", "01:00.0", "radeon", "AMD"}) {
    const auto chosen = gl::chooseGpu(gpus, wanted);
    ASSERT_TRUE(chosen) << wanted;
    EXPECT_EQ(*chosen, 1U) << wanted;
  }
  EXPECT_EQ(*gl::chooseGpu(gpus, "h100"), 0U);
  EXPECT_EQ(*gl::chooseGpu(gpus, "llvmpipe"), 2U);
}

TEST(GpuList, AnUnknownGpuIsAnErrorThatListsAll) {
  for (const char* const wanted : {"3", "-1", "matrox", "", "/dev/dri/renderD12", "1 "}) {
    const auto chosen = gl::chooseGpu(threeGpus(), wanted);
    ASSERT_FALSE(chosen) << wanted;
    EXPECT_EQ(chosen.error().code, Errc::kInvalidArgument);
    for (const char* const part : {"H100", "gfx1103", "0000:41:00.0", "/dev/dri/card0", "llvmpipe"})
      EXPECT_NE(chosen.error().what.find(part), std::string::npos) << chosen.error().what;
  }
  const auto none = gl::chooseGpu({}, "h100");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().what.find("no GPU that EGL lists"), std::string::npos);
}

TEST(GpuList, AnAmbiguousNameOrABrokenGpuIsRefused) {
  auto gpus = threeGpus();
  gpus[1].renderer.name = "NVIDIA T400";
  const auto two = gl::chooseGpu(gpus, "nvidia");
  ASSERT_FALSE(two);
  EXPECT_NE(two.error().what.find("more than one"), std::string::npos) << two.error().what;
  gpus[1].fault = "EGL: no OpenGL 3.3 core context";
  const auto broken = gl::chooseGpu(gpus, "1");
  ASSERT_FALSE(broken);
  EXPECT_NE(broken.error().what.find("3.3"), std::string::npos) << broken.error().what;
}

TEST(GpuList, SoftwareRenderersAreKnownByName) {
  for (const char* const name : {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe",
                                 "Software Rasterizer", "zink (llvmpipe (LLVM 15))"})
    EXPECT_TRUE(gl::isSoftwareRenderer(name)) << name;
  for (const char* const name : {"NVIDIA H100 80GB HBM3/PCIe", "AMD Radeon Graphics", "virgl"})
    EXPECT_FALSE(gl::isSoftwareRenderer(name)) << name;
}

TEST(GpuList, TheSoftwareRendererIsThereWhateverElseIs) {
  const auto context = gl::makeGlContext(gl::GlBackend::kEgl, gl::kNoGpu);
  ASSERT_TRUE(context) << context.error().what;
  EXPECT_TRUE((*context)->info().software);
  EXPECT_EQ((*context)->info().library, "EGL");
  EXPECT_NE((*context)->info().driver.find("Mesa"), std::string::npos);
  const auto further = (*context)->makeFurther();
  ASSERT_TRUE(further) << further.error().what;
  EXPECT_TRUE((*further)->info().software);
}

TEST(GpuList, EveryGpuOfThisMachineIsWhatItsNumberNames) {
  const auto gpus = gl::listGpus();
  for (std::size_t i = 0; i < gpus.size(); ++i) {
    if (!gpus[i].fault.empty()) continue;
    const auto context = gl::makeGlContext(gl::GlBackend::kEgl, std::to_string(i));
    ASSERT_TRUE(context) << context.error().what;
    EXPECT_EQ((*context)->info().software, gpus[i].renderer.software);
    if (gpus[i].renderer.software) continue;
    EXPECT_EQ((*context)->info().name, gpus[i].renderer.name);
  }
}

TEST(GpuList, OsmesaTakesNoGpu) {
  const auto context = gl::makeGlContext(gl::GlBackend::kOsmesa, "0");
  ASSERT_FALSE(context);
  EXPECT_EQ(context.error().code, Errc::kInvalidArgument);
  EXPECT_NE(context.error().what.find("OSMesa draws in software"), std::string::npos);
  EXPECT_TRUE(gl::checkGpu(gl::GlBackend::kOsmesa, gl::kAnyGpu));
}

}  // namespace
}  // namespace merlin::render
