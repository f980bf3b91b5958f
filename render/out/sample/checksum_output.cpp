#include "render/out/sample/checksum_output.h"

#include <fstream>

#include <fmt/format.h>

namespace merlin::render {

std::uint64_t checksumOf(std::span<const std::uint8_t> bytes) noexcept {
  std::uint64_t sum = 0xcbf29ce484222325U;
  for (const std::uint8_t byte : bytes) sum = (sum ^ byte) * 0x100000001b3U;
  return sum;
}

// A real output that writes files does so on a thread of its own (png_output): a disk may take
// long.
Result<std::optional<Timestamp>> ChecksumOutput::present(const Signal& signal,
                                                         const FrameInfo& info) {
  std::ofstream file(path_, std::ios::app);
  file << fmt::format("{} {:016x}\n", info.sequence, checksumOf(signal.pixels));
  file.close();
  if (!file) return Error{Errc::kIo, path_ + ": cannot be written"};
  return std::optional(clock_.now());
}

}  // namespace merlin::render
