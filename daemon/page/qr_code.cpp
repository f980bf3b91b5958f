#include "daemon/page/qr_code.h"

#include <cerrno>
#include <memory>

#include <fmt/format.h>
#include <qrencode.h>

namespace merlin::page {

Result<QrCode> qrCode(std::string_view text) {
  const auto free = [](QRcode* code) { QRcode_free(code); };
  const std::unique_ptr<QRcode, decltype(free)> made(
      QRcode_encodeData(static_cast<int>(text.size()),
                        reinterpret_cast<const unsigned char*>(text.data()), 0, QR_ECLEVEL_M),
      free);
  if (!made) {
    if (errno == ENOMEM) return Error{Errc::kIo, "no memory for a QR code"};
    return Error{Errc::kInvalidArgument,
                 fmt::format("a QR code cannot hold these {} bytes", text.size())};
  }
  QrCode code{made->width, {}};
  const auto count = static_cast<std::size_t>(code.side) * static_cast<std::size_t>(code.side);
  // The lowest bit of a module is its colour; 1 is dark.
  for (std::size_t i = 0; i < count; ++i)
    code.dark.push_back(static_cast<std::uint8_t>(made->data[i] & 1U));
  return code;
}

}  // namespace merlin::page
