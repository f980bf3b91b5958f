// The drivers that merlind knows, by name and by what they measure.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "daemon/base/clock.h"
#include "drivers/cyberglove/settings.h"
#include "drivers/evdev/settings.h"
#include "drivers/fastrak/settings.h"
#include "drivers/port/device.h"
#include "drivers/port/sample_sink.h"
#include "drivers/spaceball/settings.h"
#include "drivers/spacenav/settings.h"
#include "drivers/vrpn/settings.h"

namespace merlin {

enum class SampleKind { kGlove, kTracker, kBall };

// Settings of all drivers; each driver uses its own.
struct DriverSettings {
  CybergloveSettings cyberglove;
  FastrakSettings fastrak;
  SpaceballSettings spaceball;
  SpacenavSettings spacenav;
  EvdevSettings evdev;
  VrpnSettings vrpn;
};

struct DriverEntry {
  const char* name;
  SampleKind kind;
  int baud;  // default speed of its line; 0: it has none
  const char* help;
  std::unique_ptr<Device> (*make)(const DriverSettings&, const Clock&, SampleSink&);
};

std::span<const DriverEntry> drivers();

// nullptr if there is no driver of that name and kind.
const DriverEntry* findDriver(SampleKind kind, std::string_view name);

}  // namespace merlin
