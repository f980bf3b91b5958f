// The fixture of inventor.h with an EGL context, which needs no screen: what the node draws, and
// how it detects without the viewer's help that the view moves.
#include <cstdint>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoPerspectiveCamera.h>
#include <Inventor/sensors/SoNodeSensor.h>
#include <Inventor/sensors/SoSensorManager.h>
#include <gtest/gtest.h>

#include "tests/support/eventually.h"
#include "tests/system/inventor.h"

namespace merlin::test {
namespace {

constexpr int kPixels = 128;  // width and height of the image

class InventorDrawn : public Inventor {
 protected:
  void SetUp() override {
    Inventor::SetUp();
    openContext();
    scene_ = new SoSeparator;
    scene_->ref();
    camera_ = new SoPerspectiveCamera;
    scene_->addChild(camera_);
    scene_->addChild(new SoDirectionalLight);
    scene_->addChild(root_);
    camera_->viewAll(scene_, view_);
  }
  void TearDown() override {
    if (scene_) scene_->unref();
    Inventor::TearDown();
  }

  // Makes an OpenGL context in the compatibility profile, which Coin needs.
  void openContext() {
    const EGLDisplay display =
        eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    ASSERT_TRUE(eglInitialize(display, nullptr, nullptr));
    ASSERT_TRUE(eglBindAPI(EGL_OPENGL_API));
    const EGLint kWanted[] = {EGL_SURFACE_TYPE,
                              EGL_PBUFFER_BIT,
                              EGL_RENDERABLE_TYPE,
                              EGL_OPENGL_BIT,
                              EGL_DEPTH_SIZE,
                              24,
                              EGL_RED_SIZE,
                              8,
                              EGL_NONE};
    EGLConfig config{};
    EGLint found = 0;
    ASSERT_TRUE(eglChooseConfig(display, kWanted, &config, 1, &found) && found == 1);
    const EGLint kSize[] = {EGL_WIDTH, kPixels, EGL_HEIGHT, kPixels, EGL_NONE};
    const EGLSurface surface = eglCreatePbufferSurface(display, config, kSize);
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
    ASSERT_TRUE(eglMakeCurrent(display, surface, surface, context)) << std::hex << eglGetError();
  }

  void draw() {
    glEnable(GL_DEPTH_TEST);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    render_.apply(scene_);
    glFinish();
  }
  std::vector<std::uint8_t> picture() {
    draw();
    std::vector<std::uint8_t> rgba(4 * kPixels * kPixels);
    glReadPixels(0, 0, kPixels, kPixels, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    return rgba;
  }
  static int lit(const std::vector<std::uint8_t>& rgba) {
    int count = 0;
    // Counts pixels by their green channel.
    for (std::size_t i = 0; i < rgba.size(); i += 4) count += rgba[i + 1] > 20;
    return count;
  }
  // Draws a frame from a slightly different camera position, then does what the viewer's event loop
  // does between frames.
  void move() {
    camera_->position.setValue(camera_->position.getValue() + SbVec3f(0.001F, 0, 0));
    draw();
    turnEventLoop();
  }
  static void turnEventLoop() {
    SoDB::getSensorManager()->processTimerQueue();
    SoDB::getSensorManager()->processDelayQueue(TRUE);
  }

  SbViewportRegion view_{kPixels, kPixels};
  SoGLRenderAction render_{view_};
  SoSeparator* scene_ = nullptr;
  SoPerspectiveCamera* camera_ = nullptr;
};

TEST_F(InventorDrawn, EachResolutionIsDrawnInColour) {
  const auto whole = picture();
  EXPECT_GT(lit(whole), kPixels * kPixels / 4);
  ask(60);
  const auto coarse = picture();
  EXPECT_NEAR(lit(coarse), lit(whole), lit(whole) * 0.1);
  EXPECT_NE(coarse, whole);
  ask(800);
  EXPECT_EQ(picture(), whole);
}

TEST_F(InventorDrawn, ABrokenModelLeavesThePictureEmpty) {
  EXPECT_GT(lit(picture()), 0);
  complaints.clear();  // without a screen, Coin reports once that it finds no GLX
  whole("faces").set1Value(0, 1 << 30);
  EXPECT_EQ(lit(picture()), 0);
  EXPECT_EQ(complaints.size(), 1u);
}

TEST_F(InventorDrawn, ItFindsItsRateByItselfWhileTheViewMovesAndIsWholeAfterwards) {
  set("desiredFrameRate", "1e9");  // more than any machine can reach
  draw();
  move();
  EXPECT_EQ(current(), kTriangles);
  EXPECT_TRUE(eventually([&] {
    move();
    return current() < 50;
  }));
  EXPECT_EQ(count(), current());
  int redraws = 0;
  SoNodeSensor sensor([](void* times, SoSensor*) { ++*static_cast<int*>(times); }, &redraws);
  sensor.attach(scene_);
  EXPECT_TRUE(eventually([&] {
    draw();  // the same view, hence no motion
    turnEventLoop();
    return count() == kTriangles;
  }));
  EXPECT_EQ(redraws, 1);  // requested by the node itself
  move();
  EXPECT_EQ(count(), current());  // the full resolution returns without a delay
}

// Runs `step` for 1.2 s, which is longer than the rate control waits (1 s).
template <typename Step>
void forAWhile(Step step) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(1200);
  while (std::chrono::steady_clock::now() < end) step();
}

TEST_F(InventorDrawn, AStillViewIsNoMotionHoweverOftenItIsDrawn) {
  set("desiredFrameRate", "1e9");
  forAWhile([&] {
    draw();
    turnEventLoop();
  });
  EXPECT_EQ(current(), kTriangles);
}

TEST_F(InventorDrawn, ARestBetweenTwoMotionsIsNoSlowFrame) {
  set("desiredFrameRate", "1e9");
  draw();
  move();
  forAWhile([] { turnEventLoop(); });
  move();
  EXPECT_EQ(current(), kTriangles);
}

TEST_F(InventorDrawn, FramesOfAnInteractionAreCountedThroughCaches) {
  root_->renderCaching = SoSeparator::ON;
  set("desiredFrameRate", "1e9");
  set("interacting", "TRUE");
  EXPECT_TRUE(eventually([&] {
    draw();
    turnEventLoop();
    return current() < 50;
  }));
}

TEST_F(InventorDrawn, OnceTheViewerSaysItsFramesItsWordAloneCounts) {
  set("desiredFrameRate", "1e9");
  ask(100);
  draw();
  move();
  EXPECT_LE(count(), 100);
  frame(60);
  EXPECT_EQ(count(), kTriangles);
  set("interacting", "TRUE");
  EXPECT_LE(count(), 100);
}

}  // namespace
}  // namespace merlin::test
