#include "render/out/shared_frame.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <new>

#include <fmt/format.h>
#include <unistd.h>

namespace merlin::render::out {
namespace {

using framebuffer::Buffer;
using framebuffer::Front;
using framebuffer::Header;
using framebuffer::TileRectangle;

constexpr std::size_t kPixelAlignment = 4096;
constexpr int kCaptureTries = 10;
constexpr std::uint32_t kLargestWall = framebuffer::kMostTiles * tiles::kLargestFrame_px;

std::size_t headerRoom() {
  return (sizeof(Front) + kPixelAlignment - 1) / kPixelAlignment * kPixelAlignment;
}

std::size_t bufferOffset(std::size_t buffer, std::size_t frame_bytes) {
  return headerRoom() + buffer * frame_bytes;
}

TileRectangle rectangleOf(const tiles::Tile& tile) {
  TileRectangle r{};
  std::copy_n(tile.name.begin(), std::min(tile.name.size(), sizeof r.name - 1), r.name);
  r.kind = tile.kind == tiles::TileKind::kOperator ? 1 : 0;
  r.x = tile.x;
  r.y = tile.y;
  r.width = tile.width;
  r.height = tile.height;
  r.wall_x = tile.wall_x;
  r.wall_y = tile.wall_y;
  r.eye = tile.eye == tiles::Eye::kLeft ? 1 : tile.eye == tiles::Eye::kRight ? 2 : 0;
  return r;
}

template <typename Member>
void buffers(shm::FieldTable& t, const char* name, std::size_t at, const char* unit) {
  t.addOfEach<Member>(name, at, unit, framebuffer::kBuffers, sizeof(Buffer));
}

template <typename Member>
void tiles(shm::FieldTable& t, const char* name, std::size_t at, const char* unit) {
  t.addOfEach<Member>(name, at, unit, framebuffer::kMostTiles, sizeof(TileRectangle));
}

void addBuffersAndTiles(shm::FieldTable& t) {
  t.bare("buffer", offsetof(Header, buffers));
  buffers<std::uint64_t>(t, "offset", offsetof(Buffer, offset), "B");
  buffers<std::uint64_t>(t, "sequence", offsetof(Buffer, sequence), "");
  buffers<std::int64_t>(t, "finished_ns", offsetof(Buffer, finished_ns), "ns");
  buffers<std::uint32_t>(t, "cost", offsetof(Buffer, cost), "");
  buffers<std::uint32_t>(t, "full_detail", offsetof(Buffer, full_detail), "");
  t.bare("tile", offsetof(Header, tiles));
  tiles<decltype(TileRectangle::name)>(t, "name", offsetof(TileRectangle, name), "");
  tiles<std::uint32_t>(t, "kind", offsetof(TileRectangle, kind), "0 wall 1 operator");
  tiles<std::int32_t>(t, "x", offsetof(TileRectangle, x), "px");
  tiles<std::int32_t>(t, "y", offsetof(TileRectangle, y), "px");
  tiles<std::int32_t>(t, "width", offsetof(TileRectangle, width), "px");
  tiles<std::int32_t>(t, "height", offsetof(TileRectangle, height), "px");
  tiles<std::int32_t>(t, "wall_x", offsetof(TileRectangle, wall_x), "px");
  tiles<std::int32_t>(t, "wall_y", offsetof(TileRectangle, wall_y), "px");
  tiles<std::uint32_t>(t, "eye", offsetof(TileRectangle, eye), "0 both 1 left 2 right");
}

// For readers: a copy of a buffer's pixels is consistent if its buffer.sequence was not 0 and was
// the same before and after copying.
std::vector<shm::Field> framebufferFields() {
  shm::FieldTable t;
  t.bare("frame", 0);
  shm::addTableHeader<Header>(t);
  MERLIN_FIELD(t, Header, width, "px");
  MERLIN_FIELD(t, Header, height, "px");
  MERLIN_FIELD(t, Header, stride, "B");
  MERLIN_FIELD(t, Header, format, "");
  MERLIN_FIELD(t, Header, wall_width, "px");
  MERLIN_FIELD(t, Header, wall_height, "px");
  MERLIN_FIELD(t, Header, tile_count, "");
  t.add<std::uint32_t>("newest", offsetof(Header, newest), "buffer");
  addBuffersAndTiles(t);
  return t.take();
}

void fillHeader(Header& h, const tiles::TilePlan& plan, std::size_t size,
                std::uint64_t generation) {
  const auto frame_bytes = static_cast<std::uint64_t>(plan.frame_width) *
                           static_cast<std::uint64_t>(plan.frame_height) * 4;
  h.size = size;
  h.generation = generation;
  h.pid = static_cast<std::uint32_t>(::getpid());
  h.width = static_cast<std::uint32_t>(plan.frame_width);
  h.height = static_cast<std::uint32_t>(plan.frame_height);
  h.stride = h.width * 4;
  h.format = framebuffer::kFormatRgba8;
  h.wall_width = static_cast<std::uint32_t>(plan.wall_width);
  h.wall_height = static_cast<std::uint32_t>(plan.wall_height);
  h.tile_count = static_cast<std::uint32_t>(plan.tiles.size());
  for (std::size_t i = 0; i < framebuffer::kBuffers; ++i)
    h.buffers[i].offset = bufferOffset(i, frame_bytes);
  for (std::size_t i = 0; i < plan.tiles.size(); ++i) h.tiles[i] = rectangleOf(plan.tiles[i]);
  h.version = framebuffer::kVersion;
  h.magic = framebuffer::kMagic;
}

Error broken(const std::string& name, const std::string& what) {
  return {Errc::kMalformed, fmt::format("shared memory {}: {}", name, what)};
}

bool isInWall(const TileRectangle& t, const Header& h) {
  if (t.wall_x == -1 && t.wall_y == -1) return true;
  return t.wall_x >= 0 && t.wall_y >= 0 && std::int64_t{t.wall_x} + t.width <= h.wall_width &&
         std::int64_t{t.wall_y} + t.height <= h.wall_height;
}

// Checks every header field that copying relies on, since the writer may be any program.
Result<Ok> check(const Header& h, std::size_t size, const std::string& name) {
  if (size < sizeof(Header) || h.magic != framebuffer::kMagic)
    return broken(name, "is not a MERLIN framebuffer");
  if (h.version != framebuffer::kVersion) {
    return Error{Errc::kUnsupported,
                 fmt::format("shared memory {}: is version {}, but this program reads version {}; "
                             "use this program and merlind of the same release",
                             name, h.version, framebuffer::kVersion)};
  }
  const std::uint64_t bytes = std::uint64_t{h.stride} * h.height;
  bool good = h.format == framebuffer::kFormatRgba8 && h.stride == h.width * 4 &&
              h.width <= 32768 && h.height <= 32768 && h.wall_width <= kLargestWall &&
              h.wall_height <= kLargestWall && h.tile_count <= framebuffer::kMostTiles;
  for (const Buffer& b : h.buffers) good = good && b.offset <= size && bytes <= size - b.offset;
  for (std::size_t i = 0; good && i < h.tile_count; ++i) {
    const TileRectangle& t = h.tiles[i];
    good = t.x >= 0 && t.y >= 0 && t.width >= 0 && t.height >= 0 &&
           std::int64_t{t.x} + t.width <= h.width && std::int64_t{t.y} + t.height <= h.height &&
           isInWall(t, h);
  }
  return good ? Result<Ok>(Ok{}) : Result<Ok>(broken(name, "its header is damaged"));
}

// Calls use(pixels, sequence, buffer) with the newest frame; true if that was not overwritten
// meanwhile. `checked` is a private, checked copy of the header; the memory at `base` may change at
// any time.
template <typename Use>
bool useNewest(const Header& checked, const std::byte* base, const Use& use) {
  const auto& h = *reinterpret_cast<const Header*>(base);
  const std::size_t newest = h.newest.load(std::memory_order_acquire) % framebuffer::kBuffers;
  const Buffer& b = h.buffers[newest];
  const std::uint64_t before = b.sequence.load(std::memory_order_acquire);
  if (before == 0) return false;
  const auto* const pixels =
      reinterpret_cast<const std::uint8_t*>(base + checked.buffers[newest].offset);
  use(std::span(pixels, std::size_t{checked.stride} * checked.height), before, b);
  std::atomic_thread_fence(std::memory_order_acquire);
  return b.sequence.load(std::memory_order_relaxed) == before;
}

Error noCompleteFrame(const std::string& name) {
  return {Errc::kTimeout, fmt::format("shared memory {}: no complete frame could be read", name)};
}

}  // namespace

Result<std::unique_ptr<SharedFrameOutput>> SharedFrameOutput::make(const std::string& name,
                                                                   const tiles::TilePlan& plan,
                                                                   std::uint64_t generation,
                                                                   const Clock& clock) {
  if (plan.tiles.size() > framebuffer::kMostTiles) {
    return Error{Errc::kUnsupported, fmt::format("{} tiles; a framebuffer describes {} at most",
                                                 plan.tiles.size(), framebuffer::kMostTiles)};
  }
  const auto frame_bytes =
      static_cast<std::size_t>(plan.frame_width) * static_cast<std::size_t>(plan.frame_height) * 4;
  const std::size_t size = headerRoom() + framebuffer::kBuffers * frame_bytes;
  auto memory = SharedMemory::create(name, size);
  if (!memory) return memory.error();
  std::unique_ptr<SharedFrameOutput> sink(
      new SharedFrameOutput(name, *std::move(memory), frame_bytes, clock));
  auto& front = *new (sink->memory_.data()) Front{};
  shm::setFields(front.header, front.fields, framebufferFields());
  fillHeader(front.header, plan, size, generation);
  sink->generation_ = generation;
  return sink;
}

Result<std::optional<Timestamp>> SharedFrameOutput::present(const Signal& signal,
                                                            const FrameInfo& info) {
  const auto pixels = signal.pixels;
  assert(pixels.size() == frame_bytes_);
  const std::lock_guard lock(mutex_);
  Header& h = header();
  Buffer& b = h.buffers[next_];
  b.sequence.store(0, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);  // before any pixel changes
  std::memcpy(memory_.data() + bufferOffset(next_, frame_bytes_), pixels.data(), pixels.size());
  b.finished_ns = toNanoseconds(info.finished);
  b.cost = info.cost;
  b.full_detail = info.full_detail ? 1 : 0;
  b.sequence.store(info.sequence, std::memory_order_release);
  h.newest.store(next_, std::memory_order_release);
  next_ = static_cast<std::uint32_t>((next_ + 1) % framebuffer::kBuffers);
  return std::optional(clock_.now());
}

// Opens the segment by its name, as any other process does.
Result<std::vector<DisplayReading>> SharedFrameOutput::readBack() {
  const auto reader = SharedFrameReader::open(name_);
  if (!reader) return reader.error();
  DisplayReading reading;
  if (reader->generation() != generation_) {
    reading.found.kind = FoundPicture::Kind::kForeign;
  } else {
    const auto digest = reader->digest();
    if (!digest) return digest.error();
    reading.found.digest = *digest;
  }
  return std::vector{std::move(reading)};
}

Result<std::string> SharedFrameOutput::mend() {
  const std::lock_guard lock(mutex_);
  return memory_.mend();
}

SharedFrameReader::SharedFrameReader(std::string name, SharedMemory memory)
    : name_(std::move(name)), memory_(std::move(memory)) {
  std::copy_n(memory_.data(), header_.size(), header_.begin());
}

Result<SharedFrameReader> SharedFrameReader::open(const std::string& name,
                                                  SharedMemory::From from) {
  auto memory = SharedMemory::open(name, from);
  if (!memory) return memory.error();
  if (memory->size() < sizeof(Header)) return broken(name, "is not a MERLIN framebuffer");
  SharedFrameReader reader(name, *std::move(memory));
  const auto good = check(reader.checked(), reader.memory_.size(), name);
  if (!good) return good.error();
  return reader;
}

std::uint64_t SharedFrameReader::newest() const noexcept {
  const auto& h = *reinterpret_cast<const Header*>(memory_.data());
  const std::size_t newest = h.newest.load(std::memory_order_acquire) % framebuffer::kBuffers;
  return h.buffers[newest].sequence.load(std::memory_order_acquire);
}

Result<Ok> SharedFrameReader::copy(CapturedFrame& frame) const {
  const Header& h = checked();
  frame.width = static_cast<int>(h.width);
  frame.height = static_cast<int>(h.height);
  frame.wall_width = static_cast<int>(h.wall_width);
  frame.wall_height = static_cast<int>(h.wall_height);
  frame.tiles.assign(h.tiles, h.tiles + h.tile_count);
  frame.pixels.resize(std::size_t{h.stride} * h.height);
  const auto take = [&](std::span<const std::uint8_t> pixels, std::uint64_t sequence,
                        const Buffer& b) {
    std::memcpy(frame.pixels.data(), pixels.data(), pixels.size());
    frame.info = {sequence, fromNanoseconds(b.finished_ns), b.cost, b.full_detail != 0};
  };
  for (int i = 0; i < kCaptureTries; ++i) {
    if (useNewest(h, memory_.data(), take)) return Ok{};
  }
  return noCompleteFrame(name_);
}

Result<PictureDigest> SharedFrameReader::digest() const {
  const Header& h = checked();
  PictureDigest digest{};
  const auto take = [&](std::span<const std::uint8_t> pixels, std::uint64_t, const Buffer&) {
    digest = digestOf({static_cast<int>(h.width), static_cast<int>(h.height), pixels, h.stride,
                       PixelOrder::kRgba});
  };
  for (int i = 0; i < kCaptureTries; ++i) {
    if (useNewest(h, memory_.data(), take)) return digest;
  }
  return noCompleteFrame(name_);
}

Result<CapturedFrame> captureFrame(const std::string& name, SharedMemory::From from) {
  const auto reader = SharedFrameReader::open(name, from);
  if (!reader) return reader.error();
  CapturedFrame frame;
  const auto copied = reader->copy(frame);
  if (!copied) return copied.error();
  return frame;
}

CapturedFrame wallPicture(const CapturedFrame& frame) {
  CapturedFrame wall;
  wall.width = wall.wall_width = frame.wall_width;
  wall.height = wall.wall_height = frame.wall_height;
  wall.info = frame.info;
  const auto pixels = static_cast<std::size_t>(wall.width) * static_cast<std::size_t>(wall.height);
  if (pixels > kMostWallPixels) return wall;
  wall.pixels.assign(4 * pixels, 0);
  for (const TileRectangle& t : frame.tiles) {
    if (t.wall_x < 0) continue;  // an operator's view
    for (int row = 0; row < t.height; ++row) {
      const auto from =
          static_cast<std::ptrdiff_t>(4) * (std::ptrdiff_t{t.y + row} * frame.width + t.x);
      const auto to =
          static_cast<std::ptrdiff_t>(4) * (std::ptrdiff_t{t.wall_y + row} * wall.width + t.wall_x);
      std::copy_n(frame.pixels.begin() + from, 4 * t.width, wall.pixels.begin() + to);
    }
  }
  return wall;
}

}  // namespace merlin::render::out
