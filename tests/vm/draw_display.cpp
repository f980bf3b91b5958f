// draw_display CARD CONNECTOR FOLDER: draws signals into a display's memory without a copy, for the
// tests in the virtual machine: a shader's render target is the memory that the display shows.
// Mesa's software renderer takes the place of a GPU. It can use the card's memory when its EGL
// display is the card's own (platform GBM); merlind does not use such an EGL display. Shows one
// picture after another, prints what it found of each, writes the picture that the display has to
// show to FOLDER/N.ppm, and goes on at each line of its input.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>

#include "daemon/base/dma_buf.h"
#include "daemon/base/unique_fd.h"
#include "render/correct/correction_map.h"
#include "render/correct/gpu/shader_pass.h"
#include "render/correct/output_correction.h"
#include "render/gl/egl_import.h"
#include "render/gl/gl_context.h"
#include "render/gl/load_api.h"
#include "render/out/kms/displays.h"
#include "render/out/kms/drm_card.h"

namespace merlin {
namespace {

constexpr int kWidth = 600, kHeight = 440;  // size of the picture
// size of the display, which is black around the picture
constexpr int kModeWidth = 640, kModeHeight = 480;
constexpr int kFrames = 6;
// render node of the machine's only card
constexpr const char* kRenderNode = "/dev/dri/renderD128";

template <typename T>
T orFail(Result<T> result, const char* step) {
  if (result) return *std::move(result);
  std::fprintf(stderr, "draw_display: %s: %s\n", step, result.error().what.c_str());
  std::exit(1);
}

struct KeepsNothing final : KeptFiles {
  UniqueFd take(const std::string&) override { return {}; }
  bool keep(const std::string&, int) override { return false; }
  void forget(const std::string&) override {}
};

// A context of the software renderer whose EGL display is that of a card.
class CardContext final : public render::gl::GlContext {
 public:
  static Result<std::unique_ptr<CardContext>> make(const std::string& card) {
    auto context = std::make_unique<CardContext>();
    context->card_ = UniqueFd(::open(card.c_str(), O_RDWR | O_CLOEXEC));
    // libegl-mesa0 depends on this library; its headers are not needed for one function.
    void* const gbm = ::dlopen("libgbm.so.1", RTLD_NOW);
    const auto create =
        gbm ? reinterpret_cast<void* (*)(int)>(::dlsym(gbm, "gbm_create_device")) : nullptr;
    void* const device = create ? create(context->card_.get()) : nullptr;
    if (!device) return Error{Errc::kUnsupported, "no GBM device"};
    context->display_ = eglGetPlatformDisplay(EGL_PLATFORM_GBM_KHR, device, nullptr);
    if (!eglInitialize(context->display_, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API))
      return Error{Errc::kUnsupported, "no display"};
    const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                             3,
                             EGL_CONTEXT_MINOR_VERSION,
                             3,
                             EGL_CONTEXT_OPENGL_PROFILE_MASK,
                             EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                             EGL_NONE};
    const EGLContext made =
        eglCreateContext(context->display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
    if (!made || !eglMakeCurrent(context->display_, EGL_NO_SURFACE, EGL_NO_SURFACE, made))
      return Error{Errc::kUnsupported, "no context"};
    auto api = render::gl::loadApi([](const char* name) { return eglGetProcAddress(name); });
    if (!api) return api.error();
    context->api_ = *api;
    context->info_ = render::gl::rendererOf(context->api_, "EGL");
    return context;
  }

  Result<std::unique_ptr<GlContext>> makeFurther() const override {
    return Error{Errc::kUnsupported, "one is enough"};
  }
  Result<render::gl::RenderTarget> importTarget(const DmaBuf& buffer) const override {
    ++imports;
    return render::gl::importTarget(display_, api_, buffer);
  }

  mutable int imports = 0;

 private:
  UniqueFd card_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
};

render::correct::CorrectionMap corrected() {
  render::correct::CorrectionSettings s;
  s.corners = {12, 7, -20, 3, 5, -9, -2, -30};
  s.blend = {60, 40, 0, 30, 2.2};
  s.colour.gain = {1, 0.8, 1};
  return render::correct::makeCorrectionMap(s, kWidth, kHeight, nullptr, 1);
}

// Returns picture number `n`; each number gives another picture.
std::vector<std::uint8_t> picture(int n) {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (const int channel : {x * 255 / kWidth, y * 255 / kHeight, (x / 20 + y / 20 + n) * 40})
        pixels.push_back(static_cast<std::uint8_t>(channel));
      pixels.push_back(255);
    }
  }
  return pixels;
}

// Writes the signal, in the middle of a black picture of the display's size, as a PPM file.
void write(const std::string& path, const render::out::Signal& signal) {
  std::vector<char> rgb(std::size_t{3} * kModeWidth * kModeHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int to = (y + (kModeHeight - kHeight) / 2) * kModeWidth + x + (kModeWidth - kWidth) / 2;
      for (std::size_t c = 0; c < 3; ++c)
        rgb[3 * static_cast<std::size_t>(to) + c] =
            static_cast<char>(signal.pixels[4 * static_cast<std::size_t>(y * kWidth + x) + c]);
    }
  }
  std::ofstream file(path, std::ios::binary);
  file << "P6\n" << kModeWidth << " " << kModeHeight << "\n255\n";
  file.write(rgb.data(), static_cast<std::streamsize>(rgb.size()));
}

render::out::PictureDigest digestOf(const render::out::Signal& signal) {
  return render::out::digestOf(
      {signal.width, signal.height, signal.pixels, static_cast<std::size_t>(signal.width) * 4});
}

int run(const std::string& card, const std::string& connector, const std::string& folder) {
  KeepsNothing kept;
  const SystemClock clock;
  render::out::kms::Displays displays([&] { return render::out::kms::openDrmCard(card, kept); },
                                      clock);
  displays.add({card, connector, fmt::format("{}x{}", kModeWidth, kModeHeight)}, kWidth, kHeight);
  displays.step(Duration::zero());
  const auto context = orFail(CardContext::make(card), "a context of the card");
  render::correct::ShaderPass pass;
  orFail(pass.begin(*context), "the shader");
  render::correct::OutputCorrection drawn(corrected(), 1, &pass), on_cpu(corrected(), 1);
  std::set<const DmaBuf*> used;
  for (int n = 0; n < kFrames; ++n) {
    const std::vector<std::uint8_t> pixels = picture(n);
    const std::vector<render::out::DrawPlace> places = displays.beginDrawing(0);
    if (places.size() != 1 || !places[0].buffer) {
      std::fprintf(stderr, "draw_display: nothing to draw into: %s\n", displays.fault(0).c_str());
      return 1;
    }
    used.insert(places[0].buffer.get());
    const render::out::Signal signal = drawn.draw({kWidth, kHeight, pixels}, places);
    const auto meant = digestOf(signal);
    const auto shown =
        displays.present(0, signal.drawn ? std::span<const std::uint8_t>() : signal.pixels,
                         static_cast<std::uint64_t>(n) + 1);
    // the emulated machine may need several steps until the display shows the picture
    bool same = false;
    for (int i = 0; i < 200 && !same; ++i) {
      displays.step(std::chrono::milliseconds(50));
      const auto read = displays.readBack(0);
      same = read && read->size() == 1 && read->front().found.digest == meant;
    }
    write(fmt::format("{}/{}.ppm", folder, n), on_cpu.apply({kWidth, kHeight, pixels}));
    fmt::print("frame {}: {}, {}, read back {}; {} buffers, {} imports{}\n", n,
               signal.drawn ? "drawn" : "copied: " + pass.drawFault() + displays.copyReason(0),
               shown && *shown ? "shown" : "not shown", same ? "as meant" : "otherwise",
               used.size(), context->imports,
               places[0].buffer->device == deviceFolder(kRenderNode)
                   ? ""
                   : "; not the memory of " + std::string(kRenderNode));
    std::fflush(stdout);
    std::string line;
    if (!std::getline(std::cin, line)) break;
  }
  pass.end();
  return 0;
}

}  // namespace
}  // namespace merlin

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "draw_display CARD CONNECTOR FOLDER\n");
    return 2;
  }
  return merlin::run(argv[1], argv[2], argv[3]);
}
