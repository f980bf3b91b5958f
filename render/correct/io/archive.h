// Archive: reads a zip file in memory, using libzip. Nothing is unpacked to disk.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/result.h"

struct zip;

namespace merlin::render::correct {

// Thread-bound.
class Archive {
 public:
  static constexpr std::size_t kMostEntries = 1024;

  // Borrows `bytes`. Errors: kMalformed (not a zip archive, a truncated one, or an entry whose name
  // contains a folder or a path separator); kUnsupported (more than kMostEntries); kIo (no memory).
  static Result<Archive> open(std::span<const std::byte> bytes);

  // Returns the whole uncompressed entry. Errors: kNotFound; kUnsupported (more than `most_bytes`);
  // kMalformed (it cannot be decompressed, or its checksum is wrong).
  Result<std::vector<std::byte>> read(const std::string& name, std::size_t most_bytes) const;

 private:
  struct Close {
    void operator()(zip* archive) const noexcept;
  };

  std::unique_ptr<zip, Close> zip_;
};

// Returns a zip file with these entries (name, content), in this order. Equal entries give equal
// bytes. Errors: kIo (no memory).
Result<std::string> zipBytes(const std::vector<std::pair<std::string, std::string>>& entries);

}  // namespace merlin::render::correct
