#include "drivers/emulate/emulator.h"

#include <algorithm>

#include "drivers/cyberglove/settings.h"
#include "drivers/emulate/cyberglove_emulator.h"
#include "drivers/emulate/fastrak_emulator.h"
#include "drivers/emulate/names.h"
#include "drivers/emulate/spaceball_emulator.h"
#include "drivers/fastrak/settings.h"
#include "drivers/spaceball/settings.h"

namespace merlin::emulate {
namespace {

constexpr EmulatorEntry kEmulators[] = {
    {"cyberglove", kCybergloveBaud, "22|18", "CyberGlove with its interface unit", makeCyberglove},
    {"fastrak", kFastrakBaud, "1|2|3|4", "Polhemus Fastrak; the model is the number of receivers",
     makeFastrak},
    {"spaceball", kSpaceballBaud, "2003|1003|3003|4000", "Spaceball", makeSpaceball},
};
static_assert(std::ranges::equal(kEmulators, kEmulated, {}, [](const EmulatorEntry& entry) {
  return std::string_view(entry.name);
}));

}  // namespace

std::span<const EmulatorEntry> emulators() { return kEmulators; }

const EmulatorEntry* findEmulator(std::string_view name) {
  for (const EmulatorEntry& entry : kEmulators) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

bool hasModel(const EmulatorEntry& entry, std::string_view model) {
  std::string_view models = entry.models;
  while (!model.empty() && !models.empty()) {
    const std::size_t n = std::min(models.find('|'), models.size());
    if (models.substr(0, n) == model) return true;
    models.remove_prefix(std::min(n + 1, models.size()));
  }
  return model.empty();
}

}  // namespace merlin::emulate
