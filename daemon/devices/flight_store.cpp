#include "daemon/devices/flight_store.h"

#include <algorithm>
#include <new>
#include <string_view>

#include "daemon/base/fixed_text.h"
#include "drivers/port/samples.h"

namespace merlin::devices {
namespace {

struct Described {
  char name[32], driver[32];
  std::int32_t baud;
};
// Header at the start of the shared memory; the rings of the devices follow it.
struct Front {
  std::uint64_t form;     // kForm
  std::uint32_t devices;  // number of rings (FlightMemory) that follow
  Described device[kMostDevices];
};

// Number of the memory's layout. It depends on the size of FlightMemory; the constant in it must be
// increased if the meaning of FlightMemory changes but not its size.
constexpr std::uint64_t kForm = (std::uint64_t{0x4D464C31} << 32) + sizeof(FlightMemory);
constexpr std::size_t kFront = (sizeof(Front) + 4095) / 4096 * 4096;

std::size_t sizeFor(std::size_t devices) { return kFront + devices * sizeof(FlightMemory); }

std::byte* placeOf(const SharedMemory& memory, std::size_t i) {
  return memory.data() + kFront + i * sizeof(FlightMemory);
}

const Front& frontOf(const SharedMemory& memory) {
  return *reinterpret_cast<const Front*>(memory.data());
}

// Whether the text may become a part of a file name.
bool isName(std::string_view text) {
  return std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  });
}

bool isWhole(const SharedMemory& memory) {
  if (memory.size() < kFront) return false;
  const Front& front = frontOf(memory);
  return front.form == kForm && front.devices <= kMostDevices &&
         memory.size() == sizeFor(front.devices);
}

}  // namespace

LeftFlight LeftFlight::under(const std::string& name) {
  LeftFlight left;
  if (SharedMemory::owned(name)) return left;
  auto memory = SharedMemory::open(name, SharedMemory::From::kOwnUserOrRoot);
  if (memory && isWhole(*memory)) left.memory_ = *std::move(memory);
  return left;
}

std::vector<FlightDevice> LeftFlight::devices() const {
  std::vector<FlightDevice> devices;
  if (!memory_.data()) return devices;
  const Front& front = frontOf(memory_);
  for (std::size_t i = 0; i < front.devices; ++i) {
    const Described& d = front.device[i];
    const std::string_view name = isName(textIn(d.name)) ? textIn(d.name) : "";
    devices.push_back({std::string(name), std::string(textIn(d.driver)), d.baud});
  }
  return devices;
}

const FlightMemory& LeftFlight::memory(std::size_t i) const {
  return *reinterpret_cast<const FlightMemory*>(placeOf(memory_, i));
}

Result<FlightStore> FlightStore::make(const std::string& name, std::size_t devices) {
  auto memory = SharedMemory::create(name, sizeFor(devices));
  if (!memory) return memory.error();
  auto& front = *new (memory->data()) Front{};
  front.devices = static_cast<std::uint32_t>(devices);
  front.form = kForm;
  for (std::size_t i = 0; i < devices; ++i) new (placeOf(*memory, i)) FlightMemory();
  return FlightStore(*std::move(memory));
}

void FlightStore::describe(std::size_t i, const FlightDevice& device) {
  Described& d = reinterpret_cast<Front*>(memory_.data())->device[i];
  setText(d.name, device.name);
  setText(d.driver, device.driver);
  d.baud = device.baud;
}

FlightMemory& FlightStore::memory(std::size_t i) const {
  return *reinterpret_cast<FlightMemory*>(placeOf(memory_, i));
}

}  // namespace merlin::devices
