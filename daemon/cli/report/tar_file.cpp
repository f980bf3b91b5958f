#include "daemon/cli/report/tar_file.h"

#include <cerrno>
#include <memory>

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include "daemon/base/files.h"

namespace merlin::cli {
namespace {

struct FreeArchive {
  void operator()(archive* a) const noexcept { archive_write_free(a); }
};
struct FreeEntry {
  void operator()(archive_entry* e) const noexcept { archive_entry_free(e); }
};
using Archive = std::unique_ptr<archive, FreeArchive>;
using Entry = std::unique_ptr<archive_entry, FreeEntry>;

la_ssize_t writeBytes(archive* a, void* to, const void* bytes, std::size_t size) {
  const auto& write = *static_cast<const WriteBytes*>(to);
  if (write({static_cast<const std::byte*>(bytes), size})) return static_cast<la_ssize_t>(size);
  archive_set_error(a, EIO, "the file could not be written");
  return ARCHIVE_FATAL;
}

bool add(archive* a, const PackedFile& file, std::int64_t time_s) {
  const Entry entry(archive_entry_new());
  if (!entry) return false;
  archive_entry_set_pathname(entry.get(), file.name.c_str());
  archive_entry_set_size(entry.get(), static_cast<la_int64_t>(file.content.size()));
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_perm(entry.get(), 0644);
  archive_entry_set_mtime(entry.get(), time_s, 0);
  if (archive_write_header(a, entry.get()) != ARCHIVE_OK) return false;
  const la_ssize_t written = archive_write_data(a, file.content.data(), file.content.size());
  return written == static_cast<la_ssize_t>(file.content.size());
}

// Opens the archive in the format pax, which allows names of any length with any characters;
// returns false after an error.
bool open(archive* a, const WriteBytes& write) {
  // libarchive passes the pointer to writeBytes().
  void* const to = const_cast<WriteBytes*>(&write);
  return archive_write_set_format_pax_restricted(a) == ARCHIVE_OK &&
         archive_write_add_filter_gzip(a) == ARCHIVE_OK &&
         archive_write_set_filter_option(a, "gzip", "timestamp", nullptr) == ARCHIVE_OK &&
         archive_write_open(a, to, nullptr, writeBytes, nullptr) == ARCHIVE_OK;
}

}  // namespace

Result<Ok> writeTarGz(const std::string& path, std::span<const PackedFile> files,
                      std::int64_t time_s) {
  std::string fault;
  const mode_t before = ::umask(0077);
  auto written = writeFile(path, [&](const WriteBytes& write) {
    const Archive a(archive_write_new());
    if (!a) return false;
    bool good = open(a.get(), write);
    for (const PackedFile& file : files) good = good && add(a.get(), file, time_s);
    good = good && archive_write_close(a.get()) == ARCHIVE_OK;
    if (const char* text = archive_error_string(a.get()); !good && text) fault = text;
    return good;
  });
  ::umask(before);
  if (written || fault.empty()) return written;
  return Error{Errc::kIo, fmt::format("{} (libarchive: {})", written.error().what, fault)};
}

}  // namespace merlin::cli
