// Files: a copy of one in our own memory, a read-only mapping of one, and writing one whole or not
// at all.
//
// The rule: what merlind reads it reads by FileCopy, so that nothing that another program does to
// a file afterwards changes what was checked, or ends the wall. MappedFile is for the tools' large
// inputs, which need not fit into memory.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "daemon/base/huge_array.h"
#include "daemon/base/result.h"

namespace merlin {

// What tells a file's content from another one under the same name: it changes when the file is
// written, cut, or replaced.
struct FileStamp {
  std::uint64_t device = 0, inode = 0, size = 0;
  std::int64_t modified_ns = 0, changed_ns = 0;  // of the file system's clock
  auto operator<=>(const FileStamp&) const = default;
};
// Of what `path` names, through links; nothing where there is no regular file.
std::optional<FileStamp> fileStamp(const std::string& path);

// A whole file, copied into our own memory. Reentrant.
class FileCopy {
 public:
  static constexpr std::size_t kAll = ~std::size_t{0};
  // Reads the first `most` bytes, all of them where the file has no more. O(file).
  // Errors: kNotFound; kIo (also: larger than this machine's memory, or it changed while it was
  // read); kMalformed (not a regular file).
  static Result<FileCopy> read(const std::string& path, std::size_t most = kAll);

  std::span<const std::byte> bytes() const noexcept { return {bytes_.data(), size_}; }
  std::string_view text() const noexcept {
    return {reinterpret_cast<const char*>(bytes_.data()), size_};
  }
  // Of the file when it was read.
  const FileStamp& stamp() const noexcept { return stamp_; }

 private:
  HugeArray<std::byte> bytes_;
  std::size_t size_ = 0;
  FileStamp stamp_;
};

// A whole file as bytes, by mmap: pages come as they are touched. Reentrant. Not for merlind.
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
