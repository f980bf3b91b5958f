#include "drivers/hand/shapes.h"

namespace merlin::hand {
namespace {

// How far each finger is bent: MCP, PIP, DIP [rad].
struct Finger {
  float mcp, pip, dip;
};
constexpr Finger kStraight{0.05F, 0.05F, 0.05F};
constexpr Finger kBent{1.40F, 1.60F, 1.10F};
constexpr Finger kHooked{0.15F, 1.55F, 1.05F};
constexpr Finger kHalf{0.75F, 0.90F, 0.50F};
constexpr Finger kRelaxed{0.30F, 0.40F, 0.25F};

struct Thumb {
  float roll, mcp, ip, abduction;
};
constexpr Thumb kThumbOut{0.05F, 0.05F, 0.05F, 0.45F};
constexpr Thumb kThumbAcross{0.35F, 0.75F, 0.60F, 0.25F};
constexpr Thumb kThumbToIndex{0.38F, 0.30F, 0.45F, 0.35F};

// Abductions: middle-index, ring-middle, pinky-ring.
struct Spread {
  float mi, rm, pr;
};
constexpr Spread kClosed{0.0F, 0.05F, 0.05F};
constexpr Spread kWide{0.15F, 0.22F, 0.40F};

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
};

}  // namespace

std::span<const Shape> shapes() { return kShapes; }

const Shape* findShape(std::string_view name) {
  for (const Shape& shape : kShapes) {
    if (shape.name == name) return &shape;
  }
  return nullptr;
}

}  // namespace merlin::hand
