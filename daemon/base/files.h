// Files: a read-only mapping of one, and writing one whole or not at all.
#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>

#include "daemon/base/huge_array.h"
#include "daemon/base/result.h"

namespace merlin {

// A whole file as bytes, by mmap: pages come as they are touched. Reentrant.
// A file that another program cuts short while it is mapped ends this one with SIGBUS, as every
// mapping does; MERLIN's own writers replace files and never cut them.
class MappedFile {
 public:
  // Errors: kNotFound, kIo, kMalformed (not a regular file). An empty file is an empty span.
  static Result<MappedFile> open(const std::string& path);

  MappedFile() = default;
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  std::span<const std::byte> bytes() const noexcept { return {data_, size_}; }
  std::string_view text() const noexcept { return {reinterpret_cast<const char*>(data_), size_}; }

 private:
  MappedFile(const std::byte* data, std::size_t size) : data_(data), size_(size) {}

  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

// A whole file as bytes in memory of our own: what others do to the file afterwards changes
// nothing. Reentrant.
class FileCopy {
 public:
  // Errors: as MappedFile::open(); kIo also where the file gets shorter while it is read, or there
  // is not enough memory for it.
  static Result<FileCopy> read(const std::string& path);

  FileCopy() = default;
  std::span<const std::byte> bytes() const noexcept { return {bytes_.data(), size_}; }

 private:
  HugeArray<std::byte> bytes_;
  std::size_t size_ = 0;
};

// Takes bytes in order; false where the file could not take them (the disk is full).
using WriteBytes = std::function<bool(std::span<const std::byte>)>;

// Whether files can be made in this folder. Errors: kNotFound, kIo (not a folder, not ours).
Result<Ok> checkWritableFolder(const std::string& path);
// The same of one that may be missing, and would then be made with those above it.
Result<Ok> checkFolder(const std::string& path);

// Calls `fill` to write a temporary file in the same folder, then syncs it and renames it to
// `path`: readers see the old file or the whole new one. Where anything fails the old one stays.
// Errors: kNotFound (no such folder), kIo (also where `path` is a device, a pipe, a socket).
Result<Ok> writeFile(const std::string& path, const std::function<bool(const WriteBytes&)>& fill);
Result<Ok> writeFile(const std::string& path, std::string_view content);

// The same, for a file that opens with what is known last (counts, checksums): `fill` writes what
// stands behind the first `head_size` bytes, then `head` returns these.
Result<Ok> writeFileHeadLast(const std::string& path, std::size_t head_size,
                             const std::function<bool(const WriteBytes&)>& fill,
                             const std::function<std::span<const std::byte>()>& head);

// Whether writeFile() could put a file there, as far as can be said before: to be asked before long
// work. Errors: kNotFound (no such folder), kIo (not writable, a folder, a device).
Result<Ok> checkWritable(const std::string& path);
// The same of each that is not empty.
Result<Ok> checkWritable(std::initializer_list<std::string> paths);

}  // namespace merlin
