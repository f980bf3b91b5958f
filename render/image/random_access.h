// RandomAccess: the port (an interface) to bytes that can be read at any offset. Implemented for
// files by FileAccess and for memory by tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "daemon/base/files.h"
#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::render::image {

// Thread-safe.
class RandomAccess {
 public:
  virtual ~RandomAccess() = default;

  // Returns the number of bytes when the file was opened; it may have become shorter since.
  virtual std::uint64_t size() const noexcept = 0;
  // Fills `bytes` with the bytes from `offset` on. Errors: kMalformed (the file ends earlier), kIo.
  virtual Result<Ok> read(std::uint64_t offset, std::span<std::uint8_t> bytes) const = 0;
};

// A file that stays open: it can be read after its name is gone. Reads by pread(), never by mmap(),
// so that a file that is truncated meanwhile causes an error and does not end the process.
class FileAccess final : public RandomAccess {
 public:
  // Opens a file; never blocks on a pipe or a device. Errors: kNotFound, kIo, kMalformed (not a
  // regular file).
  static Result<std::unique_ptr<FileAccess>> open(const std::string& path);
  // Takes over a file that is already open. `path`: for messages. Errors: kIo, kMalformed (not a
  // regular file).
  static Result<std::unique_ptr<FileAccess>> of(UniqueFd file, const std::string& path);

  std::uint64_t size() const noexcept override { return stamp_.size; }
  Result<Ok> read(std::uint64_t offset, std::span<std::uint8_t> bytes) const override;
  // Returns the file's stamp when it was opened.
  const FileStamp& stamp() const noexcept { return stamp_; }

 private:
  FileAccess(UniqueFd file, const FileStamp& stamp) : file_(std::move(file)), stamp_(stamp) {}

  UniqueFd file_;
  FileStamp stamp_;
};

}  // namespace merlin::render::image
