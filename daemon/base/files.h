// Files: reading a file into memory, mapping a file read-only, and writing a file atomically.
//
// merlind reads files by FileCopy only, so that changes by other programs can neither alter content
// that has been checked nor crash the wall. MappedFile is for the tools' large inputs, which need
// not fit into memory.
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

// Identifies the content of a file: changes when the file is written, truncated or replaced.
struct FileStamp {
  std::uint64_t device = 0, inode = 0, size = 0;
  std::int64_t modified_ns = 0, changed_ns = 0;  // by the file system's clock
  auto operator<=>(const FileStamp&) const = default;
};
// Returns the stamp of the file at `path` (links are followed); nothing if it is not a regular
// file.
std::optional<FileStamp> fileStamp(const std::string& path);
// Returns the stamp of the regular file or folder at `path`; nothing if it is neither. The stamp of
// a folder changes when a file in it is added or removed.
std::optional<FileStamp> fileOrFolderStamp(const std::string& path);

// A whole file, copied into our own memory. Reentrant.
class FileCopy {
 public:
  static constexpr std::size_t kAll = ~std::size_t{0};
  // Reads the file, or its first `most` bytes. O(file). Errors: kNotFound; kIo (also if it is
  // larger than this machine's memory, or changed while it was read); kMalformed (not a regular
  // file).
  static Result<FileCopy> read(const std::string& path, std::size_t most = kAll);
  // Reads the open file `fd` from its beginning, like read(path). `path`: its name, for messages.
  static Result<FileCopy> read(int fd, const std::string& path, std::size_t most = kAll);

  std::span<const std::byte> bytes() const noexcept { return {bytes_.data(), size_}; }
  std::string_view text() const noexcept {
    return {reinterpret_cast<const char*>(bytes_.data()), size_};
  }
  // Returns the stamp that the file had when it was read.
  const FileStamp& stamp() const noexcept { return stamp_; }

 private:
  HugeArray<std::byte> bytes_;
  std::size_t size_ = 0;
  FileStamp stamp_;
};

// A whole file as bytes, by mmap: pages are read when they are touched. Reentrant. Not for merlind:
// if another program truncates a mapped file, access to it ends this process with SIGBUS. MERLIN's
// own writers replace files and never truncate them.
class MappedFile {
 public:
  // Errors: kNotFound, kIo, kMalformed (not a regular file), kNoMemory (this process's limit on
  // its address space leaves no room for it). An empty file is an empty span.
  static Result<MappedFile> open(const std::string& path);

  MappedFile() = default;
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  std::span<const std::byte> bytes() const noexcept { return {data_, size_}; }
  // Returns the same bytes as text, without a UTF-8 byte order mark at the beginning, because no
  // text format that MERLIN reads includes it.
  std::string_view text() const noexcept {
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    const std::string_view all(reinterpret_cast<const char*>(data_), size_);
    return all.substr(all.starts_with(kMark) ? kMark.size() : 0);
  }

 private:
  MappedFile(const std::byte* data, std::size_t size) : data_(data), size_(size) {}

  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

// Appends bytes to a file; false if that failed (the disk is full).
using WriteBytes = std::function<bool(std::span<const std::byte>)>;

// Checks that files can be created in this folder. Errors: kNotFound, kIo (not a folder, or no
// permission).
Result<Ok> checkWritableFolder(const std::string& path);
// Checks that files can be created in this folder or, if it is missing, that it and its missing
// parents can be created. Errors: those of checkWritableFolder().
Result<Ok> checkFolder(const std::string& path);

// Calls `fill` to write a temporary file in the same folder, then syncs it and renames it to
// `path`: readers see either the old file or the complete new one. After any failure the old one
// stays.
// Errors: kNotFound (no such folder), kIo (also where `path` is a device, a pipe, a socket).
Result<Ok> writeFile(const std::string& path, const std::function<bool(const WriteBytes&)>& fill);
Result<Ok> writeFile(const std::string& path, std::string_view content);

// Like writeFile(), for a file whose head is known last (counts, checksums): `fill` writes
// everything after the first `head_size` bytes, then `head` returns those.
Result<Ok> writeFileHeadLast(const std::string& path, std::size_t head_size,
                             const std::function<bool(const WriteBytes&)>& fill,
                             const std::function<std::span<const std::byte>()>& head);

// Checks, before long work and as far as possible, that writeFile() could write this file.
// Errors: kNotFound (no such folder), kIo (not writable, a folder, a device).
Result<Ok> checkWritable(const std::string& path);
// Calls checkWritable() for each path that is not empty, up to the first error.
Result<Ok> checkWritable(std::initializer_list<std::string> paths);

}  // namespace merlin
