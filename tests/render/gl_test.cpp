// Drawn by Mesa's software renderer, through EGL without a surface and through OSMesa.
#include <gtest/gtest.h>

#include "render/gl/frame_buffer.h"
#include "render/gl/gl_context.h"
#include "render/gl/model_renderer.h"
#include "render/reduce/reduce.h"
#include "tests/support/meshes.h"
#include "tests/support/pictures.h"

namespace merlin::render {
namespace {

using test::Image;
using test::Rgba;
using Source = ModelRenderer::Source;

const Rgba kBackground{15, 18, 23, 255};  // of Look, x 255, rounded

// A bumpy ball whose colours are its normals'.
Mesh ball() {
  Mesh mesh = test::sphere(5);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    float* p = &mesh.positions[3 * v];
    const float bump = 0.6F + 0.03F * std::sin(9 * p[0]) * std::cos(7 * p[1]);
    for (int k = 0; k < 3; ++k) p[k] *= bump;
  }
  ensureNormals(mesh);
  Feature colour{"colour", 3, {}};
  for (const float x : mesh.features[0].values) colour.values.push_back(0.5F + 0.5F * x);
  mesh.features.push_back(std::move(colour));
  return mesh;
}

Dendrogram wholeModel(Mesh mesh) {
  ensureNormals(mesh);
  return buildDendrogram(mesh, reduce(mesh, {})->log);
}

// With its normals as they are.
Dendrogram unreduced(const Mesh& mesh) {
  CollapseLog none;
  none.features.resize(mesh.features.size());
  return buildDendrogram(mesh, none);
}

// A picture of a model as seen along -z, x and y -1..1 from edge to edge.
class Studio {
 public:
  explicit Studio(GlBackend backend, const Dendrogram& model, int width = 160, int height = 120)
      : context_(*makeGlContext(backend)),
        frame_(*FrameBuffer::make(context_->gl(), width, height)),
        renderer_(*ModelRenderer::make(context_->gl(), model, model.arrays().triangles)) {}

  ModelRenderer& renderer() { return *renderer_; }

  void begin(const Look& look = {}) {
    Camera camera{Eigen::Matrix4f::Identity(), Eigen::Matrix3f::Identity()};
    camera.clip_from_model(2, 2) = -1;  // nearer is smaller in depth
    frame_.bind();
    renderer_->begin(frame_.width(), frame_.height(), camera, look);
  }
  Image finished() {
    Image image{frame_.width(), frame_.height(), {}};
    image.pixels.resize(std::size_t{4} * static_cast<std::size_t>(image.width * image.height));
    frame_.read(image.pixels.data(), image.width);
    return image;
  }
  Image picture(const Look& look = {}) {
    begin(look);
    renderer_->draw(Source::kFull, 0, renderer_->triangles(Source::kFull));
    return finished();
  }
  const FrameBuffer& frame() const { return frame_; }

 private:
  std::unique_ptr<GlContext> context_;
  FrameBuffer frame_;
  std::unique_ptr<ModelRenderer> renderer_;
};

// One triangle that faces the viewer, in the upper right quarter of the picture.
Mesh upperRight() { return {{0.2F, 0.2F, 0, 0.9F, 0.2F, 0, 0.2F, 0.9F, 0}, {}, {0, 1, 2}}; }

// The first level from `level` on that ends with a merge in front.
std::size_t mergesInFront(const Dendrogram& model, std::size_t level) {
  const auto z = [&](std::size_t node) { return model.arrays().positions[3 * node + 2]; };
  while (z(model.nodeCount() - 2 * level - 1) < 0.3F) ++level;
  return level;
}

// With the two that merge next at their parent's place it looks as if they had merged; without, as
// it was.
TEST(Gl, AMorphedNodeStandsWhereItIsTold) {
  const Dendrogram model = wholeModel(ball());
  Studio studio(GlBackend::kEgl, model);
  ModelRenderer& renderer = studio.renderer();
  const std::size_t level = mergesInFront(model, model.levelFor(200));
  std::vector<std::uint32_t> cut(3 * model.trianglesAt(level));
  const auto drawn = [&] {
    studio.begin();
    renderer.draw(Source::kCut, 0, renderer.triangles(Source::kCut));
    return studio.finished();
  };
  model.cut(level, cut);
  renderer.uploadCut(cut);
  const Image before = drawn();
  const auto last = static_cast<std::uint32_t>(model.nodeCount() - 2 * level);
  const std::vector<Morph> merged = {{last - 2, 0}, {last - 1, 0}};
  renderer.morph(merged);
  const Image on_its_way = drawn();
  renderer.morph({});
  EXPECT_EQ(drawn().pixels, before.pixels);
  EXPECT_NE(on_its_way.pixels, before.pixels);
  cut.resize(3 * model.trianglesAt(level + 1));
  model.cut(level + 1, cut);
  renderer.uploadCut(cut);
  EXPECT_EQ(drawn().pixels, on_its_way.pixels);
}

TEST(Gl, BothBackendsDrawTheSamePicture) {
  const Dendrogram model = wholeModel(ball());
  Image egl, osmesa;
  {
    Studio studio(GlBackend::kEgl, model);
    egl = studio.picture();
  }
  {
    Studio studio(GlBackend::kOsmesa, model);
    osmesa = studio.picture();
  }
  ASSERT_GT(egl.covered(kBackground), 5000);
  // The threshold of render/gl/README.md: at most 1 pixel in 1,000 off by more than 2 of 255.
  EXPECT_LE(1000 * differing(egl, osmesa, 2), egl.width * egl.height);
}

class GlOf : public ::testing::TestWithParam<GlBackend> {};

TEST_P(GlOf, FirstRowIsTheUpperOne) {
  const Dendrogram model = wholeModel(upperRight());
  const Image image = Studio(GetParam(), model).picture();
  EXPECT_NE(image.at(100, 40), kBackground);
  EXPECT_EQ(image.at(100, 80), kBackground);
  EXPECT_EQ(image.at(60, 40), kBackground);
  EXPECT_EQ(image.at(159, 0), kBackground);
}

TEST_P(GlOf, SlicesAndCutsAreTheSameBytesAsOneDraw) {
  const Dendrogram model = wholeModel(ball());
  Studio studio(GetParam(), model);
  const Image whole = studio.picture();
  studio.begin();
  const std::size_t all = studio.renderer().triangles(Source::kFull);
  EXPECT_EQ(all, model.triangleCount());
  for (std::size_t first = 0; first < all; first += 777) {
    studio.renderer().draw(Source::kFull, first, std::min<std::size_t>(777, all - first));
    studio.renderer().flush();
  }
  EXPECT_EQ(studio.finished().pixels, whole.pixels);

  std::vector<std::uint32_t> indices(3 * model.triangleCount());
  model.cut(0, indices);
  studio.renderer().uploadCut(indices);
  studio.begin();
  studio.renderer().draw(Source::kCut, 0, studio.renderer().triangles(Source::kCut));
  EXPECT_EQ(studio.finished().pixels, whole.pixels);
}

TEST_P(GlOf, AnyLevelIsDrawnAndLooksLikeTheModel) {
  const Dendrogram model = wholeModel(ball());
  Studio studio(GetParam(), model);
  const Image whole = studio.picture();
  std::vector<std::uint32_t> indices(3 * model.triangleCount());
  for (const std::size_t budget : {4000u, 1000u, 300u}) {
    const std::size_t triangles = model.cut(model.levelFor(budget), indices);
    studio.renderer().uploadCut(std::span(indices).first(3 * triangles));
    studio.begin();
    studio.renderer().draw(Source::kCut, 0, triangles);
    const Image image = studio.finished();
    EXPECT_NE(image.pixels, whole.pixels);
    EXPECT_LT(differing(image, whole, 48), 160 * 120 / 50) << budget;
  }
}

TEST_P(GlOf, BacksAreDrawnOnlyWhereAskedForAndLitAsFronts) {
  Mesh back = upperRight();
  std::swap(back.triangles[1], back.triangles[2]);
  Mesh front = upperRight();
  ensureNormals(front);
  back.features = front.features;
  const Dendrogram model = unreduced(back);
  Studio studio(GetParam(), model);
  EXPECT_EQ(studio.picture().covered(kBackground), 0);
  EXPECT_GT(studio.picture({.draw_back_faces = true}).covered(kBackground), 1000);
}

TEST_P(GlOf, LookIsLookedAt) {
  const Dendrogram model = wholeModel(upperRight());
  Studio studio(GetParam(), model);
  const Rgba plain = studio.picture().at(100, 40);
  const Rgba red = studio.picture({.colour = {0.5F, 0, 0}}).at(100, 40);
  EXPECT_GT(red.red, 60);
  EXPECT_EQ(red.green, 0);
  const Rgba bright = studio.picture({.colour = {0.5F, 0, 0}, .brightness = 1.5F}).at(100, 40);
  EXPECT_NEAR(bright.red, 1.5 * red.red, 2);
  EXPECT_EQ(studio.picture({.background = {1, 0, 1}}).at(0, 0), (Rgba{255, 0, 255, 255}));
  const Image wires = studio.picture({.wireframe = true});
  EXPECT_EQ(wires.at(100, 40), kBackground);  // inside
  EXPECT_GT(wires.covered(kBackground), 50);
  EXPECT_EQ(studio.picture().at(100, 40), plain);  // and nothing stays
}

TEST_P(GlOf, NearerHidesFarther) {
  Mesh near = upperRight(), far = upperRight();
  const auto paint = [](Mesh& mesh, float z, float green) {
    for (std::size_t i = 2; i < 9; i += 3) mesh.positions[i] = z;
    ensureNormals(mesh);
    mesh.features.push_back({"colour", 3, {1, green, 0, 1, green, 0, 1, green, 0}});
  };
  paint(near, 0.5F, 0);
  paint(far, -0.5F, 1);
  Mesh both = test::together(near, far);
  both.features = near.features;
  for (std::size_t f = 0; f < 2; ++f) {
    auto& values = both.features[f].values;
    values.insert(values.end(), far.features[f].values.begin(), far.features[f].values.end());
  }
  for (const bool near_last : {false, true}) {
    if (near_last)
      std::rotate(both.triangles.begin(), both.triangles.begin() + 3, both.triangles.end());
    const Dendrogram model = unreduced(both);
    const Rgba seen = Studio(GetParam(), model).picture().at(100, 40);
    EXPECT_GT(seen.red, 100);
    EXPECT_EQ(seen.green, 0) << near_last;
  }
}

TEST_P(GlOf, ReadKeepsToItsColumns) {
  const Dendrogram model = wholeModel(upperRight());
  Studio studio(GetParam(), model, 32, 16);
  studio.picture();
  constexpr int kStride = 40;
  std::vector<std::uint8_t> pixels(std::size_t{4} * kStride * 16, 7);
  studio.frame().read(pixels.data(), kStride);
  for (int y = 0; y < 16; ++y) {
    for (int x = 32; x < kStride; ++x)
      ASSERT_EQ(pixels[static_cast<std::size_t>(4 * (y * kStride + x))], 7) << x << ' ' << y;
    ASSERT_EQ(pixels[static_cast<std::size_t>(4 * y * kStride + 3)], 255);  // alpha
  }
}

TEST_P(GlOf, TooLargeAFrameBufferIsRefused) {
  const auto context = makeGlContext(GetParam());
  ASSERT_TRUE(context) << context.error().what;
  const auto frame = FrameBuffer::make((*context)->gl(), 1 << 20, 16);
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().code, Errc::kUnsupported);
  EXPECT_NE(frame.error().what.find("1048576 x 16"), std::string::npos) << frame.error().what;
}

INSTANTIATE_TEST_SUITE_P(Backends, GlOf, ::testing::Values(GlBackend::kEgl, GlBackend::kOsmesa),
                         [](const auto& backend) {
                           return backend.param == GlBackend::kEgl ? "Egl" : "Osmesa";
                         });

}  // namespace
}  // namespace merlin::render
