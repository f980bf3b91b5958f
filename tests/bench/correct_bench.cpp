// ./dev bench correct: the cost of an output's correction for each frame, compared with a memcpy of
// as many bytes and as a share of a frame's period. Measures the parts of the correction alone and
// together, on all processors, on one processor, and by a shader.
//
// The picture is noise of 1280 x 960 pixels, the size of the demo's frame. Nothing else runs. As
// all subjects take turns, the tables of a correction come from memory, as in a wall, where a whole
// frame lies between two passes.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "daemon/base/thread_team.h"
#include "render/correct/gpu/shader_pass.h"
#include "render/correct/output_correction.h"
#include "render/gl/gl_context.h"
#include "render/governor/settings.h"
#include "tests/bench/command_line.h"
#include "tests/bench/figures.h"

namespace merlin::bench {
namespace {

using Steady = std::chrono::steady_clock;
using render::correct::CorrectionSettings;

constexpr int kWidth = 1280, kHeight = 960;
constexpr double kRate_hz = render::governor::GovernorSettings{}.rate_hz;  // also the demo's rate

double msSince(Steady::time_point then) {
  return std::chrono::duration<double, std::milli>(Steady::now() - then).count();
}

// Returns settings by name; each has more parts to compute than the one before.
std::vector<std::pair<std::string, CorrectionSettings>> cases() {
  CorrectionSettings pin, mesh, blend, all;
  pin.corners = {24, 12, -31, 7, 9, -20, -14, -33};
  mesh = pin;
  mesh.mesh.columns = 9;
  mesh.mesh.rows = 7;
  for (int j = 0; j < 7; ++j) {
    for (int i = 0; i < 9; ++i)
      mesh.mesh.points.push_back(
          {i / 8.0 + 0.01 * std::sin(j), j / 6.0 + 0.02 * std::sin(i * 0.4)});
  }
  blend = mesh;
  blend.blend = {128, 128, 0, 0, 2.2};
  all = blend;
  all.black.level.fill(0.01);
  all.colour.matrix = {0.95, 0.05, 0, 0.02, 0.98, 0, 0, 0.04, 0.96};
  all.colour.gamma = {1.05, 1, 0.97};
  return {{"pin", pin}, {"mesh_pin", mesh}, {"mesh_pin_blend", blend}, {"all", all}};
}

// The shader, if OpenGL is available; its context is current.
struct Shader {
  std::unique_ptr<render::gl::GlContext> context;
  render::correct::ShaderPass pass;

  explicit Shader(const std::string& gpu) {
    auto made = render::gl::makeGlContext(render::gl::GlBackend::kEgl, gpu);
    if (!made) didNotRun("the shader", made.error().what, "see --gpu");
    context = *std::move(made);
    if (const auto begun = pass.begin(*context); !begun)
      didNotRun("the shader", begun.error().what, "see --gpu");
  }
  ~Shader() { pass.end(); }
};

// A correction to be measured.
struct Subject {
  std::string name;
  render::correct::OutputCorrection correction;
  std::vector<double> passes{};  // [ms]
};

// Makes all subjects; adds the times of computing maps of meshes [ms] to `maps`.
std::vector<Subject> subjectsOf(unsigned processors, ThreadTeam& team, Shader& shader,
                                std::vector<double>& maps) {
  std::vector<Subject> subjects;
  for (const auto& [name, settings] : cases()) {
    if (!validate(settings, kWidth, kHeight).empty())
      didNotRun(name, "its settings are not valid", "fix the benchmark");
    const auto began = Steady::now();
    const auto map = render::correct::makeCorrectionMap(settings, kWidth, kHeight, nullptr,
                                                        Threads(processors, team));
    if (!settings.mesh.isOff()) maps.push_back(msSince(began));
    subjects.push_back({name, {map, Threads(processors, team)}});
    if (processors > 1) subjects.push_back({name + "_one", {map, 1}});
    subjects.push_back({name + "_shader", {map, 1, &shader.pass}});
  }
  return subjects;
}

// Measures all subjects in turns, so that other work of the machine affects all equally. Returns
// the times of copying the picture [ms].
std::vector<double> measureInTurn(int frames, std::vector<Subject>& subjects) {
  std::mt19937 random(1);
  std::vector<std::uint8_t> picture(std::size_t{4} * kWidth * kHeight), copy(picture.size());
  for (std::uint8_t& p : picture) p = static_cast<std::uint8_t>(random());
  std::vector<double> copies;
  for (int frame = 0; frame < frames; ++frame) {
    auto began = Steady::now();
    std::memcpy(copy.data(), picture.data(), picture.size());
    asm volatile("" : : "r"(copy.data()) : "memory");
    copies.push_back(msSince(began));
    for (Subject& subject : subjects) {
      began = Steady::now();
      const auto signal = subject.correction.apply({kWidth, kHeight, picture});
      asm volatile("" : : "r"(signal.pixels.data()) : "memory");
      subject.passes.push_back(msSince(began));
    }
  }
  return copies;
}

void printSubject(const Subject& subject, const Measured& memcpy_ms, Report& report) {
  const Measured ms = medianOf(subject.passes, "passes of " + subject.name);
  const Measured ratio = ratioOf(ms, memcpy_ms, subject.name + " beside memcpy");
  const Measured share = scaled(ms, kRate_hz / 1000);
  report.text("  {:<22} {:7.2f} ms, {:.1f} memcpys, {:.1f} % of a frame at {:g} Hz\n", subject.name,
              ms.value(), ratio.value(), 100 * share.value(), kRate_hz);
  report.figure(subject.name + "_ms", ms, "ms");
  report.figure(subject.name + "_per_memcpy", ratio, "1");
  report.figure(subject.name + "_per_frame", share, "1");
}

bool measure(int frames, const std::string& gpu, Report& report) {
  const unsigned processors = threadsOr(0);
  ThreadTeam team;
  Shader shader(gpu);
  std::vector<double> maps;
  std::vector<Subject> subjects = subjectsOf(processors, team, shader, maps);
  const Measured memcpy_ms = medianOf(measureInTurn(frames, subjects), "copies of the frame");
  if (const std::string fault = shader.pass.fault(); !fault.empty())
    didNotRun("the shader", fault, "see --gpu");
  report.text("shader by {}\n", shader.context->renderer());
  report.figure("renderer", shader.context->renderer(), 1);
  report.text("correction of {} x {} pixels, medians of {} frames, {} processors\n", kWidth,
              kHeight, frames, processors);
  report.text("  {:<22} {:7.2f} ms\n", "memcpy", memcpy_ms.value());
  report.figure("memcpy_ms", memcpy_ms, "ms");
  const Measured map_ms = medianOf(maps, "maps of meshes");
  report.text("  {:<22} {:7.2f} ms, once\n", "map of a mesh", map_ms.value());
  report.figure("map_ms", map_ms, "ms");
  // the last subject of each case is the shader
  const std::size_t of_a_case = processors > 1 ? 3 : 2;
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    printSubject(subjects[i], memcpy_ms, report);
    if (i % of_a_case != of_a_case - 1) continue;
    const Subject& cpu = subjects[i + 1 - of_a_case];
    const Measured ratio = ratioOf(medianOf(subjects[i].passes, "passes of the shader"),
                                   medianOf(cpu.passes, "passes of the CPU"), cpu.name);
    report.text("  {:<22} {:7.2f} times as long as on the CPU\n", "", ratio.value());
    report.figure(cpu.name + "_shader_per_cpu", ratio, "1");
  }
  return true;
}

}  // namespace
}  // namespace merlin::bench

int main(int argc, char** argv) {
  merlin::bench::CommandLine app("The cost of an output's correction for each frame");
  int frames = 200;
  app.option("--frames", frames, "Number of frames for each correction").range(1, 100'000);
  std::string gpu = merlin::render::gl::kAnyGpu;
  app.option("--gpu", gpu, "The GPU that runs the shader, as in /wall/render/gpu").showDefault();
  return app.run("correct", argc, argv, [&](merlin::bench::Report& report) {
    return merlin::bench::measure(frames, gpu, report);
  });
}
