#include "drivers/emulate/emulator.h"

#include "drivers/emulate/cyberglove_emulator.h"
#include "drivers/emulate/fastrak_emulator.h"
#include "drivers/emulate/spaceball_emulator.h"

namespace merlin::emulate {
namespace {

constexpr EmulatorEntry kEmulators[] = {
    {"cyberglove", 38400, "22|18", "CyberGlove with its interface unit", makeCyberglove},
    {"fastrak", 38400, "1|2|3|4", "Polhemus Fastrak; the model is the number of receivers",
     makeFastrak},
    {"spaceball", 9600, "2003|3003|4000", "Spaceball", makeSpaceball},
};

}  // namespace

std::span<const EmulatorEntry> emulators() { return kEmulators; }

const EmulatorEntry* findEmulator(std::string_view name) {
  for (const EmulatorEntry& entry : kEmulators) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

}  // namespace merlin::emulate
