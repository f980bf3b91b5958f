// Tests that draw with Mesa's software renderer, through surfaceless EGL and through OSMesa.
#include <utility>

#include <gtest/gtest.h>

#include "render/content/model_renderer.h"
#include "render/gl/gl_context.h"
#include "render/gl/render_target.h"
#include "render/reduce/reduce.h"
#include "tests/support/meshes.h"
#include "tests/support/pictures.h"

namespace merlin::render {
namespace {

using test::Image;
using test::Rgba;
using Source = content::ModelRenderer::Source;

const Rgba kBackground{15, 18, 23, 255};  // RenderStyle's background x 255, rounded

// Returns a bumpy ball whose colours are derived from its normals.
mesh::Mesh ball() {
  mesh::Mesh mesh = test::sphere(5);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    float* p = &mesh.positions[3 * v];
    const float bump = 0.6F + 0.03F * std::sin(9 * p[0]) * std::cos(7 * p[1]);
    for (int k = 0; k < 3; ++k) p[k] *= bump;
  }
  mesh::ensureNormals(mesh);
  mesh::Feature colour{"colour", 3, {}};
  for (const float x : mesh.features[0].values) colour.values.push_back(0.5F + 0.5F * x);
  mesh.features.push_back(std::move(colour));
  return mesh;
}

lod::Dendrogram wholeModel(mesh::Mesh mesh) {
  mesh::ensureNormals(mesh);
  return lod::buildDendrogram(mesh, reduce::reduce(mesh, {})->log);
}

// Returns a dendrogram without collapses; the mesh's normals are kept.
lod::Dendrogram unreduced(const mesh::Mesh& mesh) {
  lod::CollapseLog none;
  none.features.resize(mesh.features.size());
  return lod::buildDendrogram(mesh, none);
}

// Draws a model seen along -z; x and y range from -1 to 1 across the image.
class Studio {
 public:
  explicit Studio(gl::GlBackend backend, const lod::Dendrogram& model, int width = 160,
                  int height = 120, const content::ShownFeature& show = {},
                  const gl::TextureImage* texture = nullptr)
      : context_(*gl::makeGlContext(backend)),
        frame_(*gl::RenderTarget::make(context_->gl(), width, height)),
        renderer_(*content::ModelRenderer::make(context_->gl(), model, model.arrays().triangles,
                                                show, texture)) {}

  content::ModelRenderer& renderer() { return *renderer_; }

  void begin(const content::RenderStyle& look = {}) {
    content::Camera camera{Eigen::Matrix4f::Identity(), Eigen::Matrix3f::Identity()};
    camera.clip_from_model(2, 2) = -1;  // larger z is nearer
    frame_.bind();
    renderer_->begin(frame_.width(), frame_.height(), camera, look);
  }
  Image finished() {
    Image image{frame_.width(), frame_.height(), {}};
    image.pixels.resize(std::size_t{4} * static_cast<std::size_t>(image.width * image.height));
    frame_.read(image.pixels.data(), image.width);
    return image;
  }
  Image picture(const content::RenderStyle& look = {}) {
    begin(look);
    renderer_->draw(Source::kFull, 0, renderer_->triangles(Source::kFull));
    return finished();
  }
  const gl::RenderTarget& frame() const { return frame_; }

 private:
  std::unique_ptr<gl::GlContext> context_;
  gl::RenderTarget frame_;
  std::unique_ptr<content::ModelRenderer> renderer_;
};

// Returns a triangle that faces the viewer, in the upper right quarter of the image.
mesh::Mesh upperRight() { return {{0.2F, 0.2F, 0, 0.9F, 0.2F, 0, 0.2F, 0.9F, 0}, {}, {0, 1, 2}}; }

// Returns the first level, from `level` on, whose last merge is on the side that faces the viewer.
std::size_t mergesInFront(const lod::Dendrogram& model, std::size_t level) {
  const auto z = [&](std::size_t node) { return model.arrays().positions[3 * node + 2]; };
  while (z(model.nodeCount() - 2 * level - 1) < 0.3F) ++level;
  return level;
}

// If the two nodes that are merged next are morphed to their parent's position, the image equals
// that after the merge; otherwise it is unchanged.
TEST(Gl, AMorphedNodeStandsWhereItIsTold) {
  const lod::Dendrogram model = wholeModel(ball());
  Studio studio(gl::GlBackend::kEgl, model);
  content::ModelRenderer& renderer = studio.renderer();
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
  const std::vector<lod::Morph> merged = {{last - 2, 0}, {last - 1, 0}};
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
  const lod::Dendrogram model = wholeModel(ball());
  Image egl, osmesa;
  {
    Studio studio(gl::GlBackend::kEgl, model);
    egl = studio.picture();
  }
  {
    Studio studio(gl::GlBackend::kOsmesa, model);
    osmesa = studio.picture();
  }
  ASSERT_GT(egl.covered(kBackground), 5000);
  // The threshold of render/gl/README.md: at most 1 pixel in 1,000 differs by more than 2 of 255.
  EXPECT_LE(1000 * differing(egl, osmesa, 2), egl.width * egl.height);
}

class GlOf : public ::testing::TestWithParam<gl::GlBackend> {};

TEST_P(GlOf, FirstRowIsTheUpperOne) {
  const lod::Dendrogram model = wholeModel(upperRight());
  const Image image = Studio(GetParam(), model).picture();
  EXPECT_NE(image.at(100, 40), kBackground);
  EXPECT_EQ(image.at(100, 80), kBackground);
  EXPECT_EQ(image.at(60, 40), kBackground);
  EXPECT_EQ(image.at(159, 0), kBackground);
}

TEST_P(GlOf, SlicesAndCutsAreTheSameBytesAsOneDraw) {
  const lod::Dendrogram model = wholeModel(ball());
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
  const lod::Dendrogram model = wholeModel(ball());
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
  mesh::Mesh back = upperRight();
  std::swap(back.triangles[1], back.triangles[2]);
  mesh::Mesh front = upperRight();
  mesh::ensureNormals(front);
  back.features = front.features;
  const lod::Dendrogram model = unreduced(back);
  Studio studio(GetParam(), model);
  EXPECT_EQ(studio.picture().covered(kBackground), 0);
  EXPECT_GT(studio.picture({.draw_back_faces = true}).covered(kBackground), 1000);
}

TEST_P(GlOf, LookIsLookedAt) {
  const lod::Dendrogram model = wholeModel(upperRight());
  Studio studio(GetParam(), model);
  const Rgba plain = studio.picture().at(100, 40);
  const Rgba red = studio.picture({.colour = {0.5F, 0, 0}}).at(100, 40);
  EXPECT_GT(red.red, 60);
  EXPECT_EQ(red.green, 0);
  const Rgba bright = studio.picture({.colour = {0.5F, 0, 0}, .brightness = 1.5F}).at(100, 40);
  EXPECT_NEAR(bright.red, 1.5 * red.red, 2);
  EXPECT_EQ(studio.picture({.background = {1, 0, 1}}).at(0, 0), (Rgba{255, 0, 255, 255}));
  const Image wires = studio.picture({.wireframe = true});
  EXPECT_EQ(wires.at(100, 40), kBackground);  // inside a triangle
  EXPECT_GT(wires.covered(kBackground), 50);
  EXPECT_EQ(studio.picture().at(100, 40), plain);  // the state for wireframes does not persist
}

TEST_P(GlOf, NearerHidesFarther) {
  mesh::Mesh near = upperRight(), far = upperRight();
  const auto paint = [](mesh::Mesh& mesh, float z, float green) {
    for (std::size_t i = 2; i < 9; i += 3) mesh.positions[i] = z;
    mesh::ensureNormals(mesh);
    mesh.features.push_back({"colour", 3, {1, green, 0, 1, green, 0, 1, green, 0}});
  };
  paint(near, 0.5F, 0);
  paint(far, -0.5F, 1);
  mesh::Mesh both = test::together(near, far);
  both.features = near.features;
  for (std::size_t f = 0; f < 2; ++f) {
    auto& values = both.features[f].values;
    values.insert(values.end(), far.features[f].values.begin(), far.features[f].values.end());
  }
  for (const bool near_last : {false, true}) {
    if (near_last)
      std::rotate(both.triangles.begin(), both.triangles.begin() + 3, both.triangles.end());
    const lod::Dendrogram model = unreduced(both);
    const Rgba seen = Studio(GetParam(), model).picture().at(100, 40);
    EXPECT_GT(seen.red, 100);
    EXPECT_EQ(seen.green, 0) << near_last;
  }
}

TEST_P(GlOf, WiresAreSeenWhateverTheModelsColoursAndHiddenByFaces) {
  const mesh::Mesh near = upperRight();
  mesh::Mesh far = near;
  for (std::size_t i = 0; i < 9; ++i)
    far.positions[i] = i % 3 == 2 ? -0.5F : 0.5F * near.positions[i] + 0.15F;
  mesh::Mesh both = test::together(far, near);
  both.features = {{"colour", 3, std::vector<float>(18, 0.0F)}};
  mesh::ensureNormals(both);
  const lod::Dendrogram alone = wholeModel(near), model = unreduced(both);
  const content::RenderStyle wires{.wireframe = true};
  const Image expected = Studio(GetParam(), alone).picture(wires);
  EXPECT_EQ(Studio(GetParam(), model).picture(wires).pixels, expected.pixels);
  const Image dim = Studio(GetParam(), alone).picture({.brightness = 0.5F, .wireframe = true});
  // The brightest value is that of a colour, since alpha, which is 255 in all pixels, is left out.
  const auto brightest = [](const Image& image) {
    return *std::max_element(image.pixels.begin(), image.pixels.end(),
                             [](auto a, auto b) { return a % 255 < b % 255; });
  };
  EXPECT_NEAR(brightest(expected), 0.75 * 255, 1);
  EXPECT_NEAR(brightest(dim), 0.375 * 255, 1);
}

TEST_P(GlOf, ReadKeepsToItsColumns) {
  const lod::Dendrogram model = wholeModel(upperRight());
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
  const auto context = gl::makeGlContext(GetParam());
  ASSERT_TRUE(context) << context.error().what;
  const auto frame = gl::RenderTarget::make((*context)->gl(), 1 << 20, 16);
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().code, Errc::kUnsupported);
  EXPECT_NE(frame.error().what.find("1048576 x 16"), std::string::npos) << frame.error().what;
}

// Returns a square that fills the image; u ranges from -1 to 3, v from 0 to 1.
mesh::Mesh square() {
  mesh::Mesh mesh;
  mesh.positions = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  mesh.triangles = {0, 1, 2, 0, 2, 3};
  mesh.features = {{"normal", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}},
                   {"texcoord", 2, {-1, 0, 3, 0, 3, 1, -1, 1}},
                   {"colour", 3, {1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}}};
  return mesh;
}

// A texture of 64 x 64 pixels: upper half green, lower left blue, lower right white.
std::vector<std::uint8_t> threeColours() {
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < 64 * 64; ++i) {
    const bool above = i / 64 < 32, left = i % 64 < 32;
    const std::array<std::uint8_t, 3> green{0, 100, 0}, blue{0, 0, 100}, white{200, 200, 200};
    const auto& colour = above ? green : left ? blue : white;
    rgb.insert(rgb.end(), colour.begin(), colour.end());
  }
  return rgb;
}

TEST_P(GlOf, ATextureIsModulatedWithTheLightAndRepeats) {
  const auto rgb = threeColours();
  const gl::TextureImage texture{64, 64, rgb};
  const lod::Dendrogram model = unreduced(square());
  Studio studio(GetParam(), model, 160, 120, {}, &texture);
  const Image image = studio.picture();
  // For a normal towards the eye, the light is 1.048. The texture repeats four times from left to
  // right.
  for (const int picture : {0, 1, 2, 3}) {
    EXPECT_LE(test::difference(image.at(40 * picture + 10, 20), {0, 105, 0, 255}), 1) << picture;
    EXPECT_LE(test::difference(image.at(40 * picture + 10, 100), {0, 0, 105, 255}), 1) << picture;
    EXPECT_LE(test::difference(image.at(40 * picture + 30, 100), {210, 210, 210, 255}), 1);
  }
  content::RenderStyle dark;
  dark.brightness = 0.5F;
  EXPECT_LE(test::difference(studio.picture(dark).at(10, 20), {0, 52, 0, 255}), 1);
}

TEST_P(GlOf, AFeatureThatIsShownIsShownInsteadOfTheTexture) {
  const auto rgb = threeColours();
  const gl::TextureImage texture{64, 64, rgb};
  const lod::Dendrogram model = unreduced(square());
  Studio shown(GetParam(), model, 160, 120, {.feature = "colour"}, &texture);
  EXPECT_EQ(shown.picture().at(10, 20), (Rgba{255, 0, 0, 255}));
  Studio plain(GetParam(), model);
  EXPECT_EQ(plain.picture().at(10, 20), (Rgba{255, 0, 0, 255})) << "no picture, so its colours";
}

// Corners 0 and 1 merge into a vertex midway between them. Half-way through the geomorph, their
// texture coordinates must be interpolated too.
TEST_P(GlOf, TextureCoordinatesAreOnTheirWayToo) {
  const auto rgb = threeColours();
  const gl::TextureImage texture{64, 64, rgb};
  const mesh::Mesh mesh = square();
  lod::CollapseLog log;
  log.children = {{0, 3}};
  log.positions = {-1, 0, 0};
  log.features = {{0, 0, 1}, {-1, 0.5F}, {1, 0, 0}};
  log.error = {0.1F};
  const lod::Dendrogram model = lod::buildDendrogram(mesh, log);
  Studio studio(GetParam(), model, 160, 120, {}, &texture);
  const Image before = studio.picture();
  const auto last = static_cast<std::uint32_t>(model.nodeCount());
  const std::vector<lod::Morph> half = {{last - 2, 0.5F}, {last - 1, 0.5F}};
  studio.renderer().morph(half);
  const Image image = studio.picture();
  // On the left side v now ranges from 0.25 to 0.75, and the surface covers half of the height.
  EXPECT_EQ(image.at(1, 10), kBackground);
  EXPECT_LE(test::difference(image.at(2, 50), {0, 105, 0, 255}), 1);
  EXPECT_LE(test::difference(image.at(2, 75), {0, 0, 105, 255}), 1);
  studio.renderer().morph({});
  EXPECT_EQ(studio.picture().pixels, before.pixels);
}

INSTANTIATE_TEST_SUITE_P(Backends, GlOf,
                         ::testing::Values(gl::GlBackend::kEgl, gl::GlBackend::kOsmesa),
                         [](const auto& backend) {
                           return backend.param == gl::GlBackend::kEgl ? "Egl" : "Osmesa";
                         });

// Simulates a GPU context that the driver has reset, which the context reports once.
class LostContext final : public gl::GlContext {
 public:
  LostContext() {
    status = GL_INNOCENT_CONTEXT_RESET;
    api_.GetGraphicsResetStatus = []() -> GLenum { return std::exchange(status, GL_NO_ERROR); };
  }
  static inline GLenum status = GL_NO_ERROR;
  Result<std::unique_ptr<GlContext>> makeFurther() const override {
    return Error{Errc::kUnsupported, "none"};
  }
};

TEST(GlContext, SaysWhetherItsGpuWasReset) {
  const LostContext lost;
  EXPECT_TRUE(lost.wasReset());
  EXPECT_TRUE(lost.wasReset()) << "whoever asks next has to know it, too";
  EXPECT_FALSE((*gl::makeGlContext(gl::GlBackend::kEgl))->wasReset());
  EXPECT_FALSE((*gl::makeGlContext(gl::GlBackend::kOsmesa))->wasReset());
}

}  // namespace
}  // namespace merlin::render
