// The installed module in a Coin program: fields, files, picking, damaged models, the frame rate.
#include "tests/system/inventor.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <Inventor/SoOutput.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoWriteAction.h>
#include <Inventor/details/SoFaceDetail.h>
#include <Inventor/nodes/SoShape.h>
#include <Inventor/nodes/SoTexture2.h>
#include <Inventor/sensors/SoNodeSensor.h>
#include <gtest/gtest.h>

namespace merlin::test {
namespace {

TEST_F(Inventor, CoinLoadsTheNodeByItsName) {
  EXPECT_TRUE(node_->isOfType(SoShape::getClassTypeId()));
  EXPECT_EQ(complaints, std::vector<std::string>{});
  SbString minimum, maximum;
  field("minimumResolution")->get(minimum);
  field("maximumResolution")->get(maximum);
  EXPECT_EQ(maximum, "800");
  EXPECT_LT(std::atoi(minimum.getString()), 50);
  const int nodes = static_cast<SoMFVec3f*>(field("vertex"))->getNum();
  EXPECT_GT(nodes, 441);  // one node for each vertex of the mesh and for each edge collapse
  EXPECT_EQ(nodes, 441 + whole("parents").getNum());
  EXPECT_EQ(static_cast<SoMFVec3f*>(field("normal"))->getNum(), nodes);
  EXPECT_EQ(static_cast<SoMFColor*>(field("diffuseColor"))->getNum(), nodes);
  EXPECT_EQ(whole("faces").getNum(), 3 * kTriangles);
}

TEST_F(Inventor, AnyResolutionIsDrawnByAFieldExactToOneCollapse) {
  EXPECT_EQ(count(), kTriangles);
  for (const int asked : {799, 400, 123, 60, 800, 61}) {
    ask(asked);
    EXPECT_LE(count(), asked);
    EXPECT_GT(count(), asked - 3);
  }
}

TEST_F(Inventor, ResolutionIsKeptWithinMinimumAndMaximum) {
  set("minimumResolution", "100");
  set("maximumResolution", "600");
  ask(7);
  EXPECT_NEAR(count(), 99, 1.5);
  ask(100'000);
  EXPECT_NEAR(count(), 599, 1.5);
  set("minimumResolution", "900");  // above the maximum, which takes precedence
  EXPECT_NEAR(count(), 599, 1.5);
  set("maximumResolution", "-5");
  EXPECT_LT(count(), 50);
  EXPECT_GT(count(), 0);
}

std::string written(SoNode* root, bool binary) {
  void* memory = std::malloc(1);
  SoOutput out;
  out.setBuffer(memory, 1, std::realloc);
  out.setBinary(binary);
  SoWriteAction(&out).apply(root);
  std::size_t size = 0;
  out.getBuffer(memory, size);
  std::string bytes(static_cast<const char*>(memory), size);
  std::free(memory);
  return bytes;
}

TEST_F(Inventor, WrittenAndReadAgainItIsTheSame) {
  ask(321);
  for (const bool binary : {false, true}) {
    const std::string bytes = written(root_, binary);
    SoSeparator* again = read(bytes);
    ASSERT_NE(again, nullptr);
    again->ref();
    EXPECT_TRUE(binary || written(again, binary) == bytes);
    SoNode* other = find(again);
    ASSERT_NE(other, nullptr);
    for (const char* name : {"currentResolution", "faces", "parents", "aliveCounts"}) {
      EXPECT_TRUE(field(name)->isSame(*other->getField(name))) << name;
    }
    for (const char* name : {"vertex", "normal", "diffuseColor", "levelErrors"}) {
      const bool same = field(name)->isSame(*other->getField(name));
      EXPECT_TRUE(same || !binary) << name;  // Coin's text format keeps six digits
    }
    again->unref();
  }
  EXPECT_EQ(complaints, std::vector<std::string>{});
}

TEST_F(Inventor, WhatOneViewerSaidIsNotReadByTheNext) {
  set("desiredFrameRate", "60");
  set("interacting", "TRUE");
  frame(60);
  for (const bool binary : {false, true}) {
    SoSeparator* again = read(written(root_, binary));
    ASSERT_NE(again, nullptr);
    again->ref();
    for (const char* name : {"interacting", "frameTime"}) {
      SbString value;
      find(again)->getField(name)->get(value);
      EXPECT_TRUE(value == "FALSE" || value == "0") << name << " " << value.getString();
    }
    again->unref();
  }
  EXPECT_EQ(complaints, std::vector<std::string>{});
}

TEST_F(Inventor, HasABoxThatHoldsEveryResolution) {
  const SbBox3f whole_box = box();
  EXPECT_NEAR(whole_box.getMin()[0], 0, 0.5);
  EXPECT_NEAR(whole_box.getMax()[0], kSide, 0.5);
  EXPECT_NEAR(whole_box.getMax()[2], 1, 0.5);
  ask(50);
  EXPECT_EQ(box().getMax(), whole_box.getMax());
}

TEST_F(Inventor, ARayMeetsTheFacesOfTheResolutionDrawn) {
  const int node_count = static_cast<SoMFVec3f*>(field("vertex"))->getNum();
  for (const int asked : {800, 200, 60}) {
    ask(asked);
    const SoPickedPoint* met = pick(8.3F, 11.6F);
    ASSERT_NE(met, nullptr) << asked;
    EXPECT_NEAR(met->getPoint()[2], std::sin(0.7 * 8.3) * std::cos(0.6 * 11.6), 0.5) << asked;
    EXPECT_EQ(met->getPath()->getTail(), node_);
    const auto* face = dynamic_cast<const SoFaceDetail*>(met->getDetail());
    ASSERT_NE(face, nullptr);
    EXPECT_LT(face->getFaceIndex(), asked);
    ASSERT_EQ(face->getNumPoints(), 3);
    EXPECT_LT(face->getPoint(0)->getCoordinateIndex(), node_count);
    EXPECT_NE(face->getPoint(0)->getCoordinateIndex(), face->getPoint(1)->getCoordinateIndex());
  }
  EXPECT_EQ(pick(-3, 5), nullptr);
}

struct Seen {
  const SoMFVec3f& normals;
  int triangles = 0;
  double area = 0;
};

void see(void* data, SoCallbackAction* action, const SoPrimitiveVertex* a,
         const SoPrimitiveVertex* b, const SoPrimitiveVertex* c) {
  auto& seen = *static_cast<Seen*>(data);
  ++seen.triangles;
  // The area of the triangle's projection onto the plane z = 0.
  seen.area += (b->getPoint() - a->getPoint()).cross(c->getPoint() - a->getPoint())[2] / 2;
  EXPECT_EQ(a->getNormal(), seen.normals[a->getMaterialIndex()]);
  SbColor ambient, diffuse, specular, emission;
  float shininess, transparency;
  action->getMaterial(ambient, diffuse, specular, emission, shininess, transparency,
                      a->getMaterialIndex());
  EXPECT_NEAR(diffuse[0], 10 * a->getPoint()[0] / 255, 0.1);
  EXPECT_EQ(diffuse[2], 0);
}

TEST_F(Inventor, ItsTrianglesComeWithNormalsAndColours) {
  for (const int asked : {800, 200, 100}) {
    ask(asked);
    Seen seen{*static_cast<SoMFVec3f*>(field("normal"))};
    SoCallbackAction action;
    action.addTriangleCallback(node_->getTypeId(), see, &seen);
    action.apply(root_);
    EXPECT_EQ(seen.triangles, count());
    EXPECT_NEAR(seen.area, kSide * kSide, 25);
  }
}

TEST_F(Inventor, BrokenFieldsGiveOneErrorAndDrawNothingUntilTheyAreMended) {
  const struct {
    const char* field;
    void (*damage)(SoField& field);
    const char* error;
  } kDamages[] = {
      {"parents", [](SoField& f) { static_cast<SoMFInt32&>(f).deleteValues(5); }, "collapses need"},
      {"parents", [](SoField& f) { static_cast<SoMFInt32&>(f).set1Value(3, -1); },
       "collapse 3: the number of the parent"},
      {"faces", [](SoField& f) { static_cast<SoMFInt32&>(f).set1Value(7, 1 << 30); },
       "triangle 2: there is no node 1073741824"},
      {"faces", [](SoField& f) { static_cast<SoMFInt32&>(f).deleteValues(100); }, "not triples"},
      {"faces", [](SoField& f) { static_cast<SoMFInt32&>(f).setNum(0); }, "no triangle"},
      {"aliveCounts", [](SoField& f) { static_cast<SoMFInt32&>(f).set1Value(9, 801); }, "level 9"},
      {"levelErrors", [](SoField& f) { static_cast<SoMFFloat&>(f).deleteValues(4); },
       "levelErrors: 4 values for"},
      {"vertex", [](SoField& f) { static_cast<SoMFVec3f&>(f).set1Value(0, NAN, 0, 0); },
       "not finite"},
      {"vertex", [](SoField& f) { static_cast<SoMFVec3f&>(f).setNum(0); }, "no triangle"},
      {"normal", [](SoField& f) { static_cast<SoMFVec3f&>(f).setNum(3); }, "normal: 3 values for"},
      {"diffuseColor", [](SoField& f) { static_cast<SoMFColor&>(f).setNum(2); },
       "diffuseColor: 2 values for"},
  };
  node_->setName("hills");
  for (const auto& damage : kDamages) {
    SbString whole_field;
    field(damage.field)->get(whole_field);
    damage.damage(*field(damage.field));
    EXPECT_EQ(count(), 0) << damage.error;
    EXPECT_TRUE(box().isEmpty());
    EXPECT_EQ(pick(8.3F, 11.6F), nullptr);
    ASSERT_EQ(complaints.size(), 1u) << damage.error;
    EXPECT_NE(complaints[0].find(damage.error), std::string::npos) << complaints[0];
    EXPECT_NE(complaints[0].find("node \"hills\""), std::string::npos) << complaints[0];
    complaints.clear();
    set(damage.field, whole_field.getString());
    EXPECT_EQ(count(), kTriangles) << damage.error;
  }
}

TEST_F(Inventor, NoNumberInTheWrongPlaceLeadsItAstray) {
  unsigned state = 1;
  const auto random = [&](int below) {
    state = state * 1664525 + 1013904223;
    return static_cast<int>((state >> 8) % static_cast<unsigned>(below));
  };
  for (int i = 0; i < 300; ++i) {
    const char* const kNames[] = {"faces", "parents", "aliveCounts"};
    SoMFInt32& numbers = whole(kNames[i % 3]);
    const int at = random(numbers.getNum()), was = numbers[at];
    const int kValues[] = {-1, 0, 1 << 30, was + 1, random(900), random(300)};
    numbers.set1Value(at, kValues[random(6)]);
    ask(random(900));
    EXPECT_LE(count(), kTriangles);
    pick(8.3F, 11.6F);
    numbers.set1Value(at, was);
  }
  ask(kTriangles);
  EXPECT_EQ(count(), kTriangles);
}

TEST_F(Inventor, WhileItMovesTheRateIsHeldAndStillItIsWhole) {
  set("desiredFrameRate", "60");
  set("interacting", "TRUE");
  EXPECT_EQ(count(), kTriangles);
  // 10 frames of 800 triangles each second: 8,000 triangles a second
  for (int i = 0; i <= 10; ++i) frame(10);
  EXPECT_EQ(current(), 133);
  EXPECT_NEAR(count(), 132, 1.5);
  set("interacting", "FALSE");
  EXPECT_EQ(count(), kTriangles);  // the full resolution returns without a delay
  set("interacting", "TRUE");
  EXPECT_NEAR(count(), 132, 1.5);
}

TEST_F(Inventor, ALoopWithAMachineOfAnySpeedSettles) {
  set("desiredFrameRate", "50");
  set("interacting", "TRUE");
  for (const double triangles_a_second : {20'000.0, 10'000.0, 35'000.0}) {
    for (int i = 0; i < 500; ++i) frame(triangles_a_second / count());
    EXPECT_NEAR(count(), triangles_a_second / 50, triangles_a_second / 50 * 0.1);
  }
}

TEST_F(Inventor, FramesOfAStillModelAndOfOneByHandChangeNothing) {
  set("desiredFrameRate", "60");
  for (int i = 0; i < 50; ++i) frame(10);
  EXPECT_EQ(current(), kTriangles);
  set("interacting", "TRUE");
  set("desiredFrameRate", "0");
  ask(500);
  for (int i = 0; i < 50; ++i) frame(10);
  EXPECT_EQ(current(), 500);
}

TEST_F(Inventor, NoPauseIsTakenForSlowFrames) {
  set("desiredFrameRate", "60");
  set("interacting", "TRUE");
  frame(60);
  frame(60);
  set("interacting", "FALSE");
  time_s_ += 100;
  set("interacting", "TRUE");
  frame(60);
  EXPECT_EQ(current(), kTriangles);
  set("desiredFrameRate", "0");
  frame(0.01);
  set("desiredFrameRate", "60");
  frame(60);
  EXPECT_EQ(current(), kTriangles);
}

TEST_F(Inventor, AFrameThatChangesNothingAsksForNoOther) {
  set("desiredFrameRate", "60");
  set("minimumResolution", "300");
  set("interacting", "TRUE");
  int redraws = 0;
  SoNodeSensor sensor([](void* count, SoSensor*) { ++*static_cast<int*>(count); }, &redraws);
  sensor.setPriority(0);
  sensor.attach(root_);
  for (int i = 0; i < 10; ++i) frame(1);
  EXPECT_EQ(current(), 300);
  EXPECT_EQ(redraws, 1);
}

TEST_F(Inventor, TheRateNeverLeavesMinimumAndMaximum) {
  set("desiredFrameRate", "60");
  set("minimumResolution", "300");
  set("interacting", "TRUE");
  for (int i = 0; i < 50; ++i) frame(1);
  EXPECT_EQ(current(), 300);
  for (int i = 0; i < 500; ++i) frame(200);
  EXPECT_EQ(current(), kTriangles);
}

// A PNG image of one blue pixel.
constexpr char kBluePng[] =
    "\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x01\x00\x00"
    "\x00\x01\x08\x02\x00\x00\x00\x90\x77\x53\xde\x00\x00\x00\x0c\x49\x44\x41\x54\x78\x9c\x63"
    "\x10\x50\xf8\x00\x00\x01\x64\x01\x21\x8d\x40\x2d\x6a\x00\x00\x00\x00\x49\x45\x4e\x44\xae"
    "\x42\x60\x82";

// Returns the surface of hills() with texture coordinates, as a PLY file.
std::string hillsWithTexture() {
  std::string text = hills();
  text.insert(text.find("element face"), "property float s\nproperty float t\n");
  const std::string end = "200 0\n";
  for (std::size_t at = 0; (at = text.find(end, at)) != std::string::npos; at += end.size() + 8)
    text.insert(at + end.size() - 1, " 0.25 .5");
  return text;
}

// The texture is a node before the model, in a file of its own; the export omits the colours, so
// that viewers do not multiply them by the texture.
TEST_F(Inventor, ATextureIsANodeBeforeTheModel) {
  writeText(dir_ / "blue.ply", hillsWithTexture());
  writeText(dir_ / "blue.png", {kBluePng, sizeof kBluePng - 1});
  ASSERT_EQ(run({kMerlin, "mesh", "reduce", dir_ / "blue.ply", "--texture", dir_ / "blue.png", "-o",
                 dir_ / "blue.mrm"})
                .status,
            0);
  const Outcome done =
      run({kMerlin, "mesh", "export", dir_ / "blue.mrm", "--multiresolution", "-o", dir_ / "b.iv"});
  ASSERT_EQ(done.status, 0) << done.output;
  EXPECT_NE(done.output.find("companion files: " + (dir_ / "b.iv.png")), std::string::npos)
      << done.output;
  EXPECT_NE(done.output.find("cannot store them: colour"), std::string::npos) << done.output;
  EXPECT_TRUE(readText(dir_ / "b.iv.png") == readText(dir_ / "blue.png"));
  SoSeparator* textured = read(readText(dir_ / "b.iv"));
  ASSERT_NE(textured, nullptr);
  textured->ref();
  SoNode* node = find(textured);
  ASSERT_NE(node, nullptr);
  const int nodes = static_cast<SoMFVec3f*>(node->getField("vertex"))->getNum();
  EXPECT_EQ(static_cast<SoMFVec2f*>(node->getField("texCoord"))->getNum(), nodes);
  EXPECT_EQ(static_cast<SoMFColor*>(node->getField("diffuseColor"))->getNum(), 0);
  const int place = textured->findChild(node);
  ASSERT_GT(place, 0);
  auto* const texture = dynamic_cast<SoTexture2*>(textured->getChild(place - 1));
  ASSERT_NE(texture, nullptr);
  EXPECT_EQ(texture->filename.getValue(), "b.iv.png");
  auto* const plain = dynamic_cast<SoSeparator*>(
      static_cast<SoSFNode*>(node->getField("alternateRep"))->getValue());
  ASSERT_NE(plain, nullptr);
  EXPECT_GE(plain->findChild(texture), 0) << "its image is read once";
  SoGetPrimitiveCountAction count;
  count.apply(textured);
  EXPECT_EQ(count.getTriangleCount(), kTriangles);
  textured->unref();
}

TEST_F(Inventor, WithoutTheModuleAPlainSurfaceIsShown) {
  std::string unknown = text_;
  unknown.replace(unknown.find("SoMRFaceSet"), 11, "SoNotHereXX");
  SoSeparator* plain = read(unknown);
  ASSERT_NE(plain, nullptr);
  plain->ref();
  EXPECT_EQ(complaints, std::vector<std::string>{});
  SoGetBoundingBoxAction bounds(SbViewportRegion(64, 64));
  bounds.apply(plain);
  EXPECT_NEAR(bounds.getBoundingBox().getMax()[0], kSide, 0.5);
  SoRayPickAction ray(SbViewportRegion(64, 64));
  ray.setRay({8.3F, 11.6F, 10}, {0, 0, -1});
  ray.apply(plain);
  EXPECT_NE(ray.getPickedPoint(), nullptr);
  plain->unref();
}

}  // namespace
}  // namespace merlin::test
