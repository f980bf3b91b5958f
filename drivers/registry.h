// The drivers that merlind knows, by name and by what they measure.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "daemon/base/clock.h"
#include "daemon/base/setting_fault.h"
#include "daemon/base/settings_visitor.h"
#include "drivers/cyberglove/settings.h"
#include "drivers/evdev/settings.h"
#include "drivers/fastrak/settings.h"
#include "drivers/osc/settings.h"
#include "drivers/port/device.h"
#include "drivers/port/sample_sink.h"
#include "drivers/spaceball/settings.h"
#include "drivers/spacenav/settings.h"
#include "drivers/touch/settings.h"
#include "drivers/tuio/settings.h"
#include "drivers/vrpn/pad_settings.h"
#include "drivers/vrpn/settings.h"

namespace merlin {

// Settings of all drivers; each driver uses its own.
struct DriverSettings {
  CybergloveSettings cyberglove;
  FastrakSettings fastrak;
  SpaceballSettings spaceball;
  SpacenavSettings spacenav;
  EvdevSettings evdev;
  VrpnSettings vrpn;
  VrpnPadSettings vrpn_pad;
  OscSettings osc;
  TouchSettings touch;
  TuioSettings tuio;
};

// All that the rest of MERLIN needs to know about a driver.
struct DriverEntry {
  const char* name = nullptr;  // also the key of its settings in the configuration
  SampleKind kind = SampleKind::kGlove;
  int baud = 0;  // default speed of its line; 0: the line has no speed
  const char* help = nullptr;
  std::unique_ptr<Device> (*make)(const DriverSettings&, const Clock&, SampleSink&) = nullptr;
  // Describes the driver's own settings; null: it has none.
  void (*describe)(DriverSettings&, SettingsVisitor&) = nullptr;
  // Returns the faults of the driver's settings, also in combination with the device's line; null:
  // no fault is possible. JSON pointers are relative to the device: "/port", "/cyberglove/rate_hz".
  SettingFaults (*validate)(const DriverSettings&, const LineSettings&) = nullptr;
  bool has_keys = false;  // whether it knows the kernel's keys and buttons by name
  // Whether several devices can share one tcp:// port, each with its own connection.
  bool shares_server = false;
  // For a tracker: returns whether poses of this station (1 to kStations) can arrive; null: poses
  // of all stations can arrive.
  bool (*has_station)(const DriverSettings&, int station) = nullptr;
};

std::span<const DriverEntry> drivers();

// Returns the driver of that name; nullptr if there is none.
const DriverEntry* findDriver(std::string_view name);

// Returns "glove", "tracker", "ball" or "touch".
const char* kindName(SampleKind kind);

}  // namespace merlin
