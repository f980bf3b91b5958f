#include "drivers/pjlink/digest.h"

#include <array>
#include <cstdint>

#include <fmt/format.h>
#include <nettle/md5.h>

namespace merlin::pjlink {

std::string md5Hex(std::string_view bytes) {
  md5_ctx context;
  md5_init(&context);
  md5_update(&context, bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
  std::array<std::uint8_t, MD5_DIGEST_SIZE> digest{};
  md5_digest(&context, digest.size(), digest.data());
  std::string hex;
  for (const std::uint8_t byte : digest) hex += fmt::format("{:02x}", byte);
  return hex;
}

}  // namespace merlin::pjlink
