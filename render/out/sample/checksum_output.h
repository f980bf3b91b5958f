// A sample output to copy, compiled and tested: appends a checksum of each frame as a line to a
// text file. It is not in the table of kinds.
#pragma once

#include <string>

#include "render/out/output.h"

namespace merlin::render::out {

class ChecksumOutput final : public Output {
 public:
  // Appends lines "SEQUENCE CHECKSUM" to the file. `clock` outlives this.
  ChecksumOutput(std::string path, const Clock& clock) : path_(std::move(path)), clock_(clock) {}

  // Errors: kIo: why the line cannot be written.
  Result<std::optional<Timestamp>> present(const Signal& signal, const FrameInfo& info) override;

 private:
  std::string path_;
  const Clock& clock_;
};

// FNV-1a of the bytes, 64 bits.
std::uint64_t checksumOf(std::span<const std::uint8_t> bytes) noexcept;

}  // namespace merlin::render::out
