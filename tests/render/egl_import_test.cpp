// Imports of displays' memory by a fake driver, whose EGL functions replace those of the library in
// this program.
#include "render/gl/egl_import.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <gtest/gtest.h>

namespace merlin::render {
namespace {

constexpr std::uint32_t kFormat = 0x34325258;  // XR24 of drm_fourcc.h

struct FakeDriver {
  std::string extensions = "EGL_KHR_image_base EGL_EXT_image_dma_buf_import";
  EGLint modifiers = 0;                           // number of modifiers that the driver lists
  std::vector<std::map<EGLint, EGLint>> tries{};  // attributes of each image that was requested
};
FakeDriver driver;

// Notes the attributes and refuses every import.
EGLImageKHR createImage(EGLDisplay, EGLContext, EGLenum, EGLClientBuffer, const EGLint* at) {
  auto& attributes = driver.tries.emplace_back();
  for (; *at != EGL_NONE; at += 2) attributes[at[0]] = at[1];
  return EGL_NO_IMAGE_KHR;
}
EGLBoolean destroyImage(EGLDisplay, EGLImageKHR) { return EGL_TRUE; }
EGLBoolean queryModifiers(EGLDisplay, EGLint format, EGLint, EGLuint64KHR*, EGLBoolean*,
                          EGLint* count) {
  *count = static_cast<std::uint32_t>(format) == kFormat ? driver.modifiers : 0;
  return EGL_TRUE;
}
void takeImage(GLenum, void*) {}

class EglImport : public testing::Test {
 protected:
  EglImport() { driver = {}; }
  static std::string refusal() {
    DmaBuf buffer;
    buffer.width = 640;
    buffer.height = 480;
    buffer.format = kFormat;
    buffer.modifier = (std::uint64_t{3} << 32U) + 5;
    const auto target = gl::importTarget(nullptr, gl::GlApi{}, buffer);
    return target ? "" : target.error().what;
  }
};

TEST_F(EglImport, ADriverThatRefusesTheModifierIsNotAskedWithout) {
  driver.extensions += " EGL_EXT_image_dma_buf_import_modifiers";
  driver.modifiers = 2;
  EXPECT_NE(refusal().find("640 x 480 pixels: eglCreateImage: error 0x3009"), std::string::npos);
  ASSERT_EQ(driver.tries.size(), 1U) << "it could take rows for tiles";
  EXPECT_EQ(driver.tries[0].at(EGL_DMA_BUF_PLANE0_MODIFIER_LO_EXT), 5);
  EXPECT_EQ(driver.tries[0].at(EGL_DMA_BUF_PLANE0_MODIFIER_HI_EXT), 3);
}

TEST_F(EglImport, ADriverThatListsNoModifiersIsAskedWithout) {
  for (const char* const more : {"", " EGL_EXT_image_dma_buf_import_modifiers"}) {
    driver = {};
    driver.extensions += more;
    EXPECT_NE(refusal(), "");
    ASSERT_EQ(driver.tries.size(), 1U) << more;
    EXPECT_EQ(driver.tries[0].count(EGL_DMA_BUF_PLANE0_MODIFIER_LO_EXT), 0U) << more;
    EXPECT_EQ(driver.tries[0].at(EGL_WIDTH), 640);
  }
}

TEST_F(EglImport, ADriverThatImportsNothingIsNotAsked) {
  driver.extensions = "EGL_EXT_image_dma_buf_import_modifiers";
  EXPECT_EQ(refusal(), "the driver lacks EGL_EXT_image_dma_buf_import");
  EXPECT_TRUE(driver.tries.empty());
}

}  // namespace
}  // namespace merlin::render

extern "C" {

const char* eglQueryString(EGLDisplay, EGLint name) {
  return name == EGL_EXTENSIONS ? merlin::render::driver.extensions.c_str() : nullptr;
}

EGLint eglGetError() { return EGL_BAD_MATCH; }

__eglMustCastToProperFunctionPointerType eglGetProcAddress(const char* name) {
  using Function = __eglMustCastToProperFunctionPointerType;
  const std::string_view asked = name;
  if (asked == "eglCreateImageKHR") return reinterpret_cast<Function>(&merlin::render::createImage);
  if (asked == "eglDestroyImageKHR")
    return reinterpret_cast<Function>(&merlin::render::destroyImage);
  if (asked == "eglQueryDmaBufModifiersEXT")
    return reinterpret_cast<Function>(&merlin::render::queryModifiers);
  if (asked == "glEGLImageTargetRenderbufferStorageOES")
    return reinterpret_cast<Function>(&merlin::render::takeImage);
  return nullptr;
}
}
