// Makes records of a Linux input device, in the format of a port of kind evdev:.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/port/evdev_line.h"

namespace merlin::test {

// Returns the bytes of one record. `low`, `high` and `resolution` matter only in the description of
// an axis.
inline std::string evdevRecord(EvdevRecord::Kind kind, int code = 0, std::int32_t value = 0,
                               std::int32_t low = 0, std::int32_t high = 0,
                               std::int32_t resolution = 0) {
  EvdevRecord r;
  r.kind = kind;
  r.code = static_cast<std::uint16_t>(code);
  r.value = value;
  r.low = low;
  r.high = high;
  r.resolution = resolution;
  std::string out;
  append(r, out);
  return out;
}

// Returns the bytes of a record that gives the name of the device or of a key.
inline std::string evdevNamed(EvdevRecord::Kind kind, int code, std::string_view text) {
  EvdevRecord r;
  r.kind = kind;
  r.code = static_cast<std::uint16_t>(code);
  std::copy(text.begin(), text.end(), r.text.begin());
  std::string out;
  append(r, out);
  return out;
}

}  // namespace merlin::test
