#include "drivers/pjlink/password.h"

#include <algorithm>

#include <fmt/format.h>

#include "daemon/base/files.h"

namespace merlin::pjlink {

Result<std::string> readPassword(const std::string& path) {
  constexpr std::size_t kMost = 64;
  if (path.empty()) return std::string();
  const auto file = FileCopy::read(path, kMost + 2);
  if (!file) return file.error();
  std::string_view line = file->text();
  line = line.substr(0, line.find_first_of("\r\n"));
  const bool good = !line.empty() && line.size() <= kMost &&
                    std::ranges::all_of(line, [](char c) { return c > ' ' && c <= '~'; });
  if (good) return std::string(line);
  return Error{Errc::kMalformed,
               fmt::format("{}: its first line is not a password of 1 to {} printable ASCII "
                           "characters",
                           path, kMost)};
}

}  // namespace merlin::pjlink
