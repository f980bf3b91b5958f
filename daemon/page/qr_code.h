// QR codes, by libqrencode; the only file that uses the library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::page {

struct QrCode {
  int side = 0;                    // modules in a row; 0: no code
  std::vector<std::uint8_t> dark;  // by row, 1 or 0; without the light margin of four modules

  bool isDark(int x, int y) const {
    return dark[static_cast<std::size_t>(y) * static_cast<std::size_t>(side) +
                static_cast<std::size_t>(x)] != 0;
  }
};

// Returns the smallest code that holds these bytes and can still be read if 15 % of it is damaged
// (level M). The same text gives the same code. Errors: kInvalidArgument (empty, or more than about
// 2,300 bytes), kIo (no memory).
Result<QrCode> qrCode(std::string_view text);

}  // namespace merlin::page
