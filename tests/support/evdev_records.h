// Records of an input device of the kernel, as the port evdev: carries them.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/port/evdev_line.h"

namespace merlin::test {

// `low` and `high`: of an axis that is described.
inline std::string evdevRecord(EvdevRecord::Kind kind, int code = 0, std::int32_t value = 0,
                               std::int32_t low = 0, std::int32_t high = 0) {
  EvdevRecord r;
  r.kind = kind;
  r.code = static_cast<std::uint16_t>(code);
  r.value = value;
  r.low = low;
  r.high = high;
  std::string out;
  append(r, out);
  return out;
}

}  // namespace merlin::test
