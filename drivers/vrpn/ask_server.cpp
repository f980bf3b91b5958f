#include "drivers/vrpn/ask_server.h"

#include <array>
#include <span>
#include <string>

namespace merlin::vrpn {
namespace {

constexpr std::size_t kMostBytes = 1 << 20;
// Time limit for writing 77 bytes into an empty buffer.
constexpr Duration kWriteTime = std::chrono::milliseconds(250);

// Returns MERLIN's cookie and the description of the sender that every VRPN client has.
std::string greeting() {
  std::string bytes = vrpnCookie();
  VrpnHeader header;
  header.type = kVrpnDescribeSender;
  appendVrpn(header, vrpnName(kVrpnControl), bytes);
  return bytes;
}

}  // namespace

Result<Ok> askServer(ByteStream& stream, const Clock& clock, Timestamp until, Catalog& catalog) {
  const std::string hello = greeting();
  const auto sent = stream.write(std::as_bytes(std::span(hello)), kWriteTime);
  if (!sent) return sent.error();
  std::array<char, 4096> buffer;  // NOLINT(*-member-init): filled by read
  for (std::size_t bytes = 0; bytes < kMostBytes;) {
    const Duration left = until - clock.now();
    if (left <= Duration::zero()) break;
    const auto got = stream.read(std::as_writable_bytes(std::span(buffer)), left);
    if (!got && got.error().code == Errc::kTimeout) continue;
    if (!got) return got.error();
    bytes += *got;
    if (auto taken = catalog.take({buffer.data(), *got}); !taken) return taken;
  }
  if (catalog.greeted()) return Ok{};
  return Error{Errc::kTimeout, "no answer to VRPN's greeting"};
}

}  // namespace merlin::vrpn
