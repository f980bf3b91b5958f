// Inventor: a test fixture with a model that merlin exported, opened in a program that uses Coin
// and includes no header of MERLIN.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <Inventor/SbViewportRegion.h>
#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/SoPath.h>
#include <Inventor/SoPickedPoint.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoGetPrimitiveCountAction.h>
#include <Inventor/actions/SoRayPickAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/fields/SoFields.h>
#include <Inventor/nodes/SoSeparator.h>
#include <gtest/gtest.h>

#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace merlin::test {

inline const std::string kMerlin = std::string(MERLIN_BIN_DIR) + "/merlin";
inline constexpr int kSide = 20;  // cells along each side
inline constexpr int kTriangles = 2 * kSide * kSide;

// Returns a hilly square surface, coloured from red to green, as a PLY file.
inline std::string hills() {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex " + std::to_string((kSide + 1) * (kSide + 1)) +
      "\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face " +
      std::to_string(kTriangles) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (int y = 0; y <= kSide; ++y) {
    for (int x = 0; x <= kSide; ++x) {
      const double z = std::sin(0.7 * x) * std::cos(0.6 * y);
      text += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + " " +
              std::to_string(10 * x) + " 200 0\n";
    }
  }
  const auto face = [&](int a, int b, int c) {
    text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  };
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const int a = y * (kSide + 1) + x, c = a + kSide + 2;
      face(a, a + 1, c);
      face(a, c, c - 1);
    }
  }
  return text;
}

// Coin's error messages since the last complaints.clear().
inline std::vector<std::string> complaints;
inline void complain(const SoError* error, void*) {
  complaints.push_back(error->getDebugString().getString());
}

class Inventor : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    SoDB::init();
    SoInteraction::init();
    SoDebugError::setHandlerCallback(complain, nullptr);
    SoReadError::setHandlerCallback(complain, nullptr);
  }
  static void TearDownTestSuite() { SoDB::finish(); }

  void SetUp() override {
    writeText(dir_ / "hills.ply", hills());
    ASSERT_EQ(run({kMerlin, "mesh", "reduce", dir_ / "hills.ply", "-o", dir_ / "hills.mrm"}).status,
              0);
    const Outcome done = run({kMerlin, "mesh", "export", dir_ / "hills.mrm", "--multiresolution",
                              "-o", dir_ / "hills.iv"});
    ASSERT_EQ(done.status, 0) << done.output;
    EXPECT_NE(done.output.find(" to 800 triangles"), std::string::npos) << done.output;
    text_ = readText(dir_ / "hills.iv");
    complaints.clear();
    root_ = read(text_);
    ASSERT_NE(root_, nullptr);
    root_->ref();
    node_ = find(root_);
    ASSERT_NE(node_, nullptr);
    set("desiredFrameRate", "0");
  }
  void TearDown() override {
    if (root_) root_->unref();
  }

  static SoSeparator* read(const std::string& text) {
    SoInput in;
    in.setBuffer(text.data(), text.size());
    return SoDB::readAll(&in);
  }

  // Finds the model's node by its type name, since this program does not know the class; null if
  // there is none.
  static SoNode* find(SoNode* root) {
    SoSearchAction search;
    search.setType(SoType::fromName("SoMRFaceSet"));
    search.apply(root);
    return search.getPath() ? search.getPath()->getTail() : nullptr;
  }

  SoField* field(const char* name) { return node_->getField(name); }
  SoMFInt32& whole(const char* name) { return *static_cast<SoMFInt32*>(field(name)); }
  void set(const char* name, const char* value) { ASSERT_TRUE(field(name)->set(value)) << name; }
  void ask(int triangles) { set("currentResolution", std::to_string(triangles).c_str()); }
  int current() { return static_cast<SoSFInt32*>(field("currentResolution"))->getValue(); }

  int count() {
    SoGetPrimitiveCountAction action;
    action.apply(root_);
    return action.getTriangleCount();
  }
  SbBox3f box() {
    SoGetBoundingBoxAction action(SbViewportRegion(64, 64));
    action.apply(root_);
    return action.getBoundingBox();
  }
  // Returns the point hit by a vertical ray from above at (x, y), or null; valid until the next
  // call.
  const SoPickedPoint* pick(float x, float y) {
    pick_.setRay({x, y, 10}, {0, 0, -1});
    pick_.apply(root_);
    return pick_.getPickedPoint();
  }

  // Reports a frame to the node through the field frameTime, 1 / `hz` seconds after the last one,
  // as a viewer does.
  void frame(double hz) {
    time_s_ += 1 / hz;
    static_cast<SoSFTime*>(field("frameTime"))->setValue(time_s_);
  }

  TempDir dir_;
  std::string text_;
  SoSeparator* root_ = nullptr;
  SoNode* node_ = nullptr;
  SoRayPickAction pick_{SbViewportRegion(64, 64)};
  double time_s_ = 1000;
};

}  // namespace merlin::test
