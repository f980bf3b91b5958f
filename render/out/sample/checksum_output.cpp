#include "render/out/sample/checksum_output.h"

#include <fstream>

#include <fmt/format.h>

namespace merlin::render::out {

std::uint64_t checksumOf(std::span<const std::uint8_t> bytes) noexcept {
  std::uint64_t sum = 0xcbf29ce484222325U;
  for (const std::uint8_t byte : bytes) sum = (sum ^ byte) * 0x100000001b3U;
  return sum;
}

// A real output writes files on its own thread (see png_output), since a disk may be slow.
Result<std::optional<Timestamp>> ChecksumOutput::present(const Signal& signal,
                                                         const FrameInfo& info) {
  std::ofstream file(path_, std::ios::app);
  file << fmt::format("{} {:016x}\n", info.sequence, checksumOf(signal.pixels));
  file.close();
  if (!file) return Error{Errc::kIo, path_ + ": cannot be written"};
  return std::optional(clock_.now());
}

}  // namespace merlin::render::out
