#include "render/correct/io/archive.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <zip.h>

#include "daemon/base/printable_text.h"

namespace merlin::render::correct {
namespace {

constexpr zip_uint16_t kFirstDay = 1 << 5 | 1;  // 1980-01-01 in DOS format: a fixed date

// Returns whether the name has no folder: all entries of an MPCDI archive are at its root.
bool isPlain(std::string_view name) {
  return !name.empty() && name != "." && name != ".." &&
         name.find_first_of("/\\:") == std::string_view::npos;
}

// Returns a name from the file for messages: shortened and on one line.
std::string shown(std::string_view name) { return oneLine(excerpt(name)); }

std::string messageOf(zip_error_t& error) {
  std::string message = zip_error_strerror(&error);
  zip_error_fini(&error);
  return message;
}

Error noMemory() { return {Errc::kIo, "zip: out of memory"}; }

}  // namespace

void Archive::Close::operator()(zip* archive) const noexcept { zip_discard(archive); }

Result<Archive> Archive::open(std::span<const std::byte> bytes) {
  if (bytes.empty()) return Error{Errc::kMalformed, "is empty; an MPCDI file is a zip archive"};
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  if (!source) return noMemory();
  zip_t* opened = zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &error);
  if (!opened) {
    zip_source_free(source);
    return Error{
        Errc::kMalformed,
        fmt::format("is not a complete zip archive ({}); an MPCDI file is one", messageOf(error))};
  }
  Archive archive;
  archive.zip_.reset(opened);
  const auto count =
      static_cast<std::size_t>(std::max<zip_int64_t>(0, zip_get_num_entries(opened, 0)));
  if (count > kMostEntries)
    return Error{Errc::kUnsupported,
                 fmt::format("has {} entries; the maximum is {}", count, kMostEntries)};
  for (std::size_t i = 0; i < count; ++i) {
    const char* const name = zip_get_name(opened, i, ZIP_FL_ENC_RAW);
    if (name && isPlain(name)) continue;
    return Error{Errc::kMalformed,
                 fmt::format("has an entry \"{}\"; the files of an MPCDI archive have no folders",
                             shown(name ? name : ""))};
  }
  return archive;
}

Result<std::vector<std::byte>> Archive::read(const std::string& name, std::size_t most) const {
  zip_stat_t stat;
  zip_stat_init(&stat);
  if (zip_stat(zip_.get(), name.c_str(), 0, &stat) != 0)
    return Error{Errc::kNotFound, fmt::format("\"{}\" is not in the archive", shown(name))};
  if (!(stat.valid & ZIP_STAT_SIZE) || stat.size > most) {
    return Error{Errc::kUnsupported,
                 fmt::format("{}: has {} bytes; the maximum is {}", shown(name), stat.size, most)};
  }
  zip_file_t* const file = zip_fopen_index(zip_.get(), stat.index, 0);
  if (!file) {
    return Error{Errc::kMalformed, fmt::format("{}: {}", shown(name), zip_strerror(zip_.get()))};
  }
  // One byte more than declared: reading up to the end makes libzip verify the checksum, and an
  // entry that is longer than declared is detected.
  std::vector<std::byte> bytes(stat.size + 1);
  std::size_t got = 0;
  zip_int64_t count = 1;
  while (got < bytes.size() && count > 0) {
    count = zip_fread(file, bytes.data() + got, bytes.size() - got);
    if (count > 0) got += static_cast<std::size_t>(count);
  }
  const std::string message = count < 0 ? zip_file_strerror(file) : "";
  zip_fclose(file);
  if (count < 0) return Error{Errc::kMalformed, fmt::format("{}: {}", shown(name), message)};
  if (got != stat.size) {
    return Error{Errc::kMalformed, fmt::format("{}: its size is not the {} bytes that the archive "
                                               "declares",
                                               shown(name), stat.size)};
  }
  bytes.pop_back();
  return bytes;
}

Result<std::string> zipBytes(const std::vector<std::pair<std::string, std::string>>& entries) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* whole = zip_source_buffer_create(nullptr, 0, 0, &error);
  if (!whole) return noMemory();
  zip_source_keep(whole);  // otherwise zip_close() would free it with the bytes
  zip_t* archive = zip_open_from_source(whole, ZIP_TRUNCATE, &error);
  const auto give_up = [&] {
    if (archive) zip_discard(archive);
    zip_source_free(whole);
    return noMemory();
  };
  if (!archive) return give_up();
  for (const auto& [name, content] : entries) {
    zip_source_t* source = zip_source_buffer(archive, content.data(), content.size(), 0);
    const zip_int64_t index =
        source ? zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8) : -1;
    if (index < 0) {
      zip_source_free(source);
      return give_up();
    }
    zip_file_set_dostime(archive, static_cast<zip_uint64_t>(index), 0, kFirstDay, 0);
  }
  if (zip_close(archive) != 0) return give_up();
  zip_stat_t stat;
  std::string bytes;
  if (zip_source_stat(whole, &stat) == 0 && zip_source_open(whole) == 0) {
    bytes.resize(stat.size);
    const zip_int64_t got = zip_source_read(whole, bytes.data(), bytes.size());
    if (got != static_cast<zip_int64_t>(bytes.size())) bytes.clear();
    zip_source_close(whole);
  }
  zip_source_free(whole);
  if (bytes.empty()) return noMemory();
  return bytes;
}

}  // namespace merlin::render::correct
