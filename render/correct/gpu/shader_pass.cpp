#include "render/correct/gpu/shader_pass.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "render/gl/shader.h"

namespace merlin::render::correct {
namespace {

// Draws one triangle that covers the whole target.
constexpr const char* kVertexShader = R"(#version 330 core
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 0.0, 1.0);
}
)";

// Names, units and signs are those of the formula in correction_map.h.
constexpr const char* kFragmentShader = R"(#version 330 core
uniform sampler2D picture;
uniform isampler2D source_x, source_y;
uniform usampler2D gain, black, runs;
uniform mat3 colours;
uniform vec3 channel_gain, encode, black_level;
uniform float gamma, least_headroom;
uniform ivec2 origin;  // of the signal in the target
out vec4 signal;

vec3 at(ivec2 p) { return texelFetch(picture, p, 0).rgb; }

// Step 1. Filtered here, since a sampler may round its weights.
vec3 filtered(ivec2 p) {
  ivec2 place = ivec2(texelFetch(source_x, p, 0).r, texelFetch(source_y, p, 0).r);
  ivec2 cell = min(place >> 8, textureSize(picture, 0) - 2);
  vec2 rest = vec2(place - (cell << 8)) / 256.0;
  vec3 top = mix(at(cell), at(cell + ivec2(1, 0)), rest.x);
  vec3 bottom = mix(at(cell + ivec2(0, 1)), at(cell + ivec2(1, 1)), rest.x);
  return mix(top, bottom, rest.y);
}

vec3 power(vec3 x, vec3 y) {
  return vec3(greaterThan(x, vec3(0.0))) * pow(max(x, vec3(5e-10)), y);
}

// Steps 2 to 6.
vec3 corrected(ivec2 p, vec3 c) {
  float root = float(texelFetch(gain, p, 0).r) / 65535.0;
  float share = float(texelFetch(black, p, 0).r) / 65535.0;
  float headroom = max(share, least_headroom);
  vec3 light = max(vec3(0.0), colours * power(c, vec3(gamma)));
  light = min(vec3(1.0), light * channel_gain) * (root * root) * (1.0 - headroom * black_level) +
          share * black_level;
  return power(min(vec3(1.0), light), encode);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy) - origin;
  uint kind = texelFetch(runs, ivec2(p.x / RUN, p.y), 0).r;
  vec3 c = vec3(0.0);
  if (kind != NOTHING) c = filtered(p);
  if (kind == LIGHT) c = corrected(p, c);
  signal = vec4(c, 1.0);
}
)";

constexpr const char* kSamplers[] = {"picture", "source_x", "source_y", "gain", "black", "runs"};
constexpr std::size_t kPicture = 0;

// Returns the fragment shader's source, with the constants of correction_map.h.
std::string fragmentShader() {
  std::string source = kFragmentShader;
  const std::string define = "#define RUN " + std::to_string(kRun) + "\n#define NOTHING " +
                             std::to_string(static_cast<int>(RunKind::kNothing)) +
                             "u\n#define LIGHT " +
                             std::to_string(static_cast<int>(RunKind::kLight)) + "u\n";
  return source.insert(source.find('\n') + 1, define);
}

template <typename T>
bool isOf(const std::weak_ptr<const T>& held, const std::shared_ptr<const T>& object) {
  return !held.owner_before(object) && !object.owner_before(held);
}

std::size_t bytesOf(int width, int height) {
  return std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

// Largest allowed difference, of 255: memory formats may round differently.
constexpr int kRounding = 1;

struct Comparison {
  // same: differs by at most kRounding; lit: the signal is not black.
  bool same = true, lit = false;
};

// Compares a signal with the pixels of a display's memory, whose last column and row are the
// signal's last ones. The fourth channel is ignored, since it is not displayed.
Comparison comparisonOf(std::span<const std::uint8_t> signal, int width,
                        std::span<const std::uint8_t> memory, const out::DrawPlace& place) {
  Comparison result;
  const std::size_t row = bytesOf(width, 1), memory_row = bytesOf(place.x + width, 1);
  for (std::size_t at = 0; at < signal.size(); ++at) {
    if (at % 4 == 3) continue;
    const std::size_t y = at / row + static_cast<std::size_t>(place.y);
    const int found = memory[y * memory_row + bytesOf(place.x, 1) + at % row];
    result.same = result.same && std::abs(found - signal[at]) <= kRounding;
    result.lit = result.lit || signal[at] > kRounding;
  }
  return result;
}

}  // namespace

ShaderPass::~ShaderPass() { assert(!gl_); }

Result<Ok> ShaderPass::begin(const gl::GlContext& context, bool draws) {
  assert(!gl_);
  const gl::GlApi& gl = context.gl();
  const auto program = gl::linkProgram(gl, kVertexShader, fragmentShader().c_str());
  if (!program) return program.error();
  program_ = *program;
  gl_ = &gl;
  context_ = &context;
  draws_ = draws;
  row_reader_.emplace(gl);
  gl.GenVertexArrays(1, &vertices_);
  gl.UseProgram(program_);
  int unit = 0;
  for (const char* const name : kSamplers)
    gl.Uniform1i(gl.GetUniformLocation(program_, name), unit++);
  return Ok{};
}

void ShaderPass::end() {
  if (!gl_) return;
  tables_.clear();
  refused_.clear();
  lent_.clear();
  tellFaults();
  row_reader_.reset();
  gl_->DeleteProgram(program_);
  gl_->DeleteVertexArrays(1, &vertices_);
  gl_ = nullptr;
}

std::string ShaderPass::fault() const {
  const std::lock_guard lock(mutex_);
  return fault_;
}

std::string ShaderPass::drawFault() const {
  const std::lock_guard lock(mutex_);
  return draw_fault_;
}

// Sets fault_ and draw_fault_; called after each change of refused_, of lent_ or of its faults.
void ShaderPass::tellFaults() {
  const auto lent = std::ranges::find_if(lent_, [](const Lent& l) { return !l.fault.empty(); });
  const std::lock_guard lock(mutex_);
  fault_ = refused_.empty() ? std::string() : refused_.back().fault;
  draw_fault_ = lent == lent_.end() ? std::string() : lent->fault;
}

Result<ShaderPass::Tables> ShaderPass::makeTables(
    const std::shared_ptr<const CorrectionMap>& map) const {
  using Texels = gl::DataTexture::Texels;
  struct Table {
    Texels texels;
    int width, height;
    const void* values;
  };
  const Table all[] = {{Texels::kRgba8, map->source_width, map->source_height, nullptr},
                       {Texels::kInt32, map->stride, map->height, map->source_x.data()},
                       {Texels::kInt32, map->stride, map->height, map->source_y.data()},
                       {Texels::kUint16, map->stride, map->height, map->gain.data()},
                       {Texels::kUint16, map->stride, map->height, map->black.data()},
                       {Texels::kUint8, map->stride / kRun, map->height, map->runs.data()}};
  auto signal = gl::RenderTarget::make(*gl_, map->width, map->height, gl::Depth::kNone);
  if (!signal) return signal.error();
  Tables tables{map, {}, *std::move(signal)};
  for (const Table& table : all) {
    auto texture = gl::DataTexture::make(*gl_, table.texels, table.width, table.height);
    if (!texture) return texture.error();
    if (table.values) texture->write(table.values);
    tables.textures.push_back(*std::move(texture));
  }
  return tables;
}

Result<ShaderPass::Tables*> ShaderPass::tablesOf(const std::shared_ptr<const CorrectionMap>& map) {
  for (Tables& tables : tables_) {
    if (isOf(tables.map, map)) return &tables;
  }
  tables_.remove_if([](const Tables& t) { return t.map.expired(); });
  auto made = makeTables(map);
  if (!made) return made.error();
  tables_.push_back(*std::move(made));
  return &tables_.back();
}

void ShaderPass::setLight(const Light& light) const {
  const auto at = [this](const char* name) { return gl_->GetUniformLocation(program_, name); };
  gl_->UniformMatrix3fv(at("colours"), 1, GL_TRUE, light.matrix.data());
  gl_->Uniform3fv(at("channel_gain"), 1, light.gain.data());
  gl_->Uniform3fv(at("encode"), 1, light.encode.data());
  gl_->Uniform3fv(at("black_level"), 1, light.black.data());
  gl_->Uniform1f(at("gamma"), light.gamma);
  gl_->Uniform1f(at("least_headroom"), light.least_headroom);
}

// Returns null if this map was refused, now or before.
ShaderPass::Tables* ShaderPass::tablesUnlessRefused(
    const std::shared_ptr<const CorrectionMap>& map) {
  if (std::ranges::any_of(refused_, [&](const Refused& r) { return isOf(r.map, map); }))
    return nullptr;
  const auto tables = tablesOf(map);
  if (tables) return *tables;
  refused_.push_back({map, tables.error().what});
  tellFaults();
  return nullptr;
}

void ShaderPass::releaseUnheld() {
  const auto maps = refused_.remove_if([](const Refused& r) { return r.map.expired(); });
  const auto buffers = lent_.remove_if([](const Lent& l) { return l.buffer.expired(); });
  if (maps + buffers > 0) tellFaults();
}

// Returns null if this buffer was refused, now or before, or is null.
ShaderPass::Lent* ShaderPass::lentOf(const std::shared_ptr<const DmaBuf>& buffer) {
  if (!buffer) return nullptr;
  auto lent = std::ranges::find_if(lent_, [&](const Lent& l) { return isOf(l.buffer, buffer); });
  if (lent == lent_.end()) {
    lent = lent_.insert(lent_.end(), {buffer});
    auto target = context_->importTarget(*buffer);
    if (target)
      lent->target.emplace(*std::move(target));
    else
      lent->fault = target.error().what;
    tellFaults();
  }
  return lent->target ? &*lent : nullptr;
}

// Compares what was drawn into a display's memory with what the shader draws elsewhere, since a
// driver may import the memory and draw nothing there, or something else. Refuses the memory if
// they differ. If a driver has drawn into a copy of the memory, only PictureChecks finds this,
// which reads the memory as the display does.
bool ShaderPass::isDrawnRight(Lent& lent, const out::DrawPlace& place, const Tables& tables,
                              const CorrectionMap& map) {
  std::vector<std::uint8_t> meant(bytesOf(map.width, map.height));
  drawAt(tables.signal, 0, 0, tables, map);
  tables.signal.read(meant.data(), map.width);
  const int right = place.x + map.width, bottom = place.y + map.height;
  std::vector<std::uint8_t> found(bytesOf(right, bottom));
  lent.target->read(found.data(), right, right, bottom);
  const Comparison comparison = comparisonOf(meant, map.width, found, place);
  if (!comparison.same) {
    lent.target.reset();
    lent.fault = "the driver has drawn another picture into the display's memory than was meant";
    tellFaults();
    return false;
  }
  // New memory is black, so that a black picture proves nothing.
  lent.is_right = comparison.lit;
  return true;
}

void ShaderPass::drawAt(const gl::RenderTarget& target, int x, int y, const Tables& tables,
                        const CorrectionMap& map) const {
  target.bind();
  gl_->Viewport(x, y, map.width, map.height);
  for (const int test : {GL_DEPTH_TEST, GL_CULL_FACE, GL_SCISSOR_TEST, GL_BLEND})
    gl_->Disable(static_cast<GLenum>(test));
  gl_->UseProgram(program_);
  setLight(map.light);
  gl_->Uniform2i(gl_->GetUniformLocation(program_, "origin"), x, y);
  for (std::size_t i = 0; i < tables.textures.size(); ++i)
    tables.textures[i].bind(static_cast<int>(i));
  gl_->BindVertexArray(vertices_);
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);
}

bool ShaderPass::run(const std::shared_ptr<const CorrectionMap>& map,
                     std::span<const std::uint8_t> picture, std::span<std::uint8_t> signal) {
  if (!gl_) return false;
  releaseUnheld();
  const Tables* const tables = tablesUnlessRefused(map);
  if (!tables) return false;
  tables->textures[kPicture].write(picture.data());
  drawAt(tables->signal, 0, 0, *tables, *map);
  tables->signal.read(signal.data(), map->width);
  return !context_->wasReset();  // after a reset nothing is drawn, and no call fails
}

bool ShaderPass::draw(const std::shared_ptr<const CorrectionMap>& map,
                      std::span<const std::uint8_t> picture, std::span<const out::DrawPlace> places,
                      std::span<const int> rows, std::span<std::uint8_t> signal) {
  if (!canDraw()) return false;
  releaseUnheld();
  std::vector<Lent*> lent;
  for (const out::DrawPlace& place : places) {
    lent.push_back(lentOf(place.buffer));
    if (!lent.back()) return false;
  }
  const Tables* const tables = tablesUnlessRefused(map);
  if (!tables) return false;
  tables->textures[kPicture].write(picture.data());
  for (std::size_t i = 0; i < lent.size(); ++i)
    drawAt(*lent[i]->target, places[i].x, places[i].y, *tables, *map);
  readRows(*lent.front()->target, places.front(), map->width, rows, signal);
  // The display's card may not wait for the GPU, so the buffer is handed over only when drawing has
  // finished.
  gl_->Finish();
  if (context_->wasReset()) return false;
  for (std::size_t i = 0; i < lent.size(); ++i)
    if (!lent[i]->is_right && !isDrawnRight(*lent[i], places[i], *tables, *map)) return false;
  return true;
}

// Copies rows of the signal, as they are in the display's memory, to their places in `signal`.
void ShaderPass::readRows(const gl::RenderTarget& target, const out::DrawPlace& place, int width,
                          std::span<const int> rows, std::span<std::uint8_t> signal) {
  std::vector<int> in_target;
  for (const int row : rows) in_target.push_back(place.y + row);
  const std::size_t bytes = bytesOf(width, 1);
  row_pixels_.resize(rows.size() * bytes);
  row_reader_->startRows(target, place.x, width, in_target);
  row_reader_->finish(row_pixels_.data(), width);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::memcpy(signal.data() + static_cast<std::size_t>(rows[r]) * bytes,
                row_pixels_.data() + r * bytes, bytes);
  }
}

}  // namespace merlin::render::correct
