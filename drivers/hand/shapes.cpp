#include "drivers/hand/shapes.h"

namespace merlin::hand {
namespace {

// Flexion angles of a finger's joints MCP, PIP and DIP [rad].
struct Finger {
  float mcp, pip, dip;
};
constexpr Finger kStraight{0.05F, 0.05F, 0.05F};
constexpr Finger kBent{1.40F, 1.60F, 1.10F};
constexpr Finger kHooked{0.15F, 1.55F, 1.05F};
constexpr Finger kHalf{0.75F, 0.90F, 0.50F};
constexpr Finger kRelaxed{0.30F, 0.40F, 0.25F};
constexpr Finger kCupped{0.55F, 0.75F, 0.45F};
constexpr Finger kToThumb{0.95F, 0.85F, 0.45F};  // its tip touches the thumb's tip
constexpr Finger kClawed{0.10F, 1.00F, 0.75F};
constexpr Finger kFolded{1.35F, 0.10F, 0.05F};  // bent at the MCP only
constexpr Finger kCurled{0.60F, 1.35F, 0.90F};

struct Thumb {
  float roll, mcp, ip, abduction;
};
constexpr Thumb kThumbOut{0.05F, 0.05F, 0.05F, 0.45F};
constexpr Thumb kThumbAcross{0.35F, 0.75F, 0.60F, 0.25F};
constexpr Thumb kThumbToIndex{0.38F, 0.30F, 0.45F, 0.35F};
constexpr Thumb kThumbBeside{0.05F, 0.10F, 0.10F, 0.22F};
constexpr Thumb kThumbOpposed{0.38F, 0.15F, 0.15F, 0.48F};
constexpr Thumb kThumbToRing{0.40F, 0.60F, 0.40F, 0.40F};
constexpr Thumb kThumbToPinky{0.40F, 0.80F, 0.55F, 0.45F};
constexpr Thumb kThumbTucked{0.40F, 0.85F, 0.15F, 0.22F};

// Abductions between neighbouring fingers [rad]: middle-index, ring-middle, pinky-ring.
struct Spread {
  float mi, rm, pr;
};
constexpr Spread kClosed{0.0F, 0.05F, 0.05F};
constexpr Spread kWide{0.15F, 0.22F, 0.40F};
constexpr Spread kCrossed{-0.18F, 0.05F, 0.05F};  // index over middle
constexpr Spread kOnlyPinky{0.0F, 0.05F, 0.40F};

constexpr Shape make(const char* name, Thumb t, Finger i, Finger m, Finger r, Finger p, Spread s,
                     float arch) {
  return {name,
          {t.roll, t.mcp, t.ip,  t.abduction, i.mcp, i.pip, i.dip, 0.0F, m.mcp, m.pip, m.dip, s.mi,
           r.mcp,  r.pip, r.dip, s.rm,        p.mcp, p.pip, p.dip, s.pr, arch,  0.0F,  0.0F}};
}

constexpr Shape kShapes[] = {
    make("open", kThumbOut, kStraight, kStraight, kStraight, kStraight, kWide, 0.05F),
    make("fist", kThumbAcross, kBent, kBent, kBent, kBent, kClosed, 0.25F),
    make("point", kThumbAcross, kStraight, kBent, kBent, kBent, kClosed, 0.20F),
    make("pinch", kThumbToIndex, kHalf, kRelaxed, kRelaxed, kRelaxed, kClosed, 0.15F),
    make("thumb-up", kThumbOut, kBent, kBent, kBent, kBent, kClosed, 0.20F),
    make("victory", kThumbAcross, kStraight, kStraight, kBent, kBent, kWide, 0.15F),
    make("hook", kThumbOut, kHooked, kHooked, kHooked, kHooked, kClosed, 0.10F),
    make("horns", kThumbAcross, kStraight, kBent, kBent, kStraight, kClosed, 0.15F),
    make("flat", kThumbBeside, kStraight, kStraight, kStraight, kStraight, kClosed, 0.05F),
    make("four", kThumbAcross, kStraight, kStraight, kStraight, kStraight, kWide, 0.10F),
    make("three", kThumbAcross, kStraight, kStraight, kStraight, kBent, kWide, 0.12F),
    make("three-thumb", kThumbOut, kStraight, kStraight, kBent, kBent, kWide, 0.12F),
    make("two", kThumbAcross, kStraight, kStraight, kBent, kBent, kClosed, 0.15F),
    make("crossed", kThumbAcross, kStraight, kStraight, kBent, kBent, kCrossed, 0.15F),
    make("pistol", kThumbOut, kStraight, kBent, kBent, kBent, kClosed, 0.15F),
    make("trigger", kThumbOut, kCurled, kBent, kBent, kBent, kClosed, 0.15F),
    make("bent-index", kThumbAcross, kHooked, kBent, kBent, kBent, kClosed, 0.20F),
    make("pinky", kThumbAcross, kBent, kBent, kBent, kStraight, kOnlyPinky, 0.20F),
    make("call", kThumbOut, kBent, kBent, kBent, kStraight, kOnlyPinky, 0.15F),
    make("love", kThumbOut, kStraight, kBent, kBent, kStraight, kOnlyPinky, 0.12F),
    make("ok", kThumbToIndex, kToThumb, kStraight, kStraight, kStraight, kWide, 0.15F),
    make("middle-to-thumb", kThumbToIndex, kStraight, kToThumb, kStraight, kStraight, kWide, 0.18F),
    make("ring-to-thumb", kThumbToRing, kStraight, kStraight, kToThumb, kStraight, kWide, 0.25F),
    make("pinky-to-thumb", kThumbToPinky, kStraight, kStraight, kStraight, kToThumb, kWide, 0.35F),
    make("beak", kThumbToIndex, kToThumb, kToThumb, kToThumb, kToThumb, kClosed, 0.25F),
    make("cup", kThumbOpposed, kCupped, kCupped, kCupped, kCupped, kClosed, 0.20F),
    make("claw", kThumbOpposed, kClawed, kClawed, kClawed, kClawed, kWide, 0.15F),
    make("roof", kThumbBeside, kFolded, kFolded, kFolded, kFolded, kClosed, 0.15F),
    make("grip", kThumbOpposed, kCurled, kCurled, kCurled, kCurled, kClosed, 0.25F),
    make("tucked", kThumbTucked, kBent, kBent, kBent, kBent, kClosed, 0.30F),
    make("rest", kThumbBeside, kRelaxed, kRelaxed, kRelaxed, kRelaxed, kClosed, 0.10F),
};

}  // namespace

// The first eight are the postures of the shipped network.
std::span<const Shape> shapes() { return std::span(kShapes).first(8); }
std::span<const Shape> allShapes() { return kShapes; }

const Shape* findShape(std::string_view name) {
  for (const Shape& shape : kShapes) {
    if (shape.name == name) return &shape;
  }
  return nullptr;
}

}  // namespace merlin::hand
