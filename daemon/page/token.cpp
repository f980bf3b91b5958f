#include "daemon/page/token.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <optional>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>

namespace merlin::page {
namespace {

constexpr std::size_t kCharacters = 32;
constexpr mode_t kMode = 0640;

Error failed(const std::string& path) {
  return {Errc::kIo, fmt::format("{}: {}", path, std::strerror(errno))};
}

// Makes a token of 32 random characters, 6 bits each.
Result<std::string> newToken() {
  constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  static_assert(kAlphabet.size() == 64);
  std::array<unsigned char, kCharacters> random{};
  if (::getrandom(random.data(), random.size(), 0) != static_cast<ssize_t>(random.size()))
    return failed("cannot get random numbers for the page's token");
  std::string token;
  for (const unsigned char byte : random) token += kAlphabet[byte % kAlphabet.size()];
  return token;
}

bool isToken(std::string_view text) {
  return text.size() == kCharacters && std::ranges::all_of(text, [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '-' || c == '_';
         });
}

// Returns the token in the file; nothing unless it is valid, this user owns the file, only the user
// and the file's group can read it, and only the user can write it.
std::optional<std::string> tokenIn(const UniqueFd& file) {
  struct stat status {};
  if (::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode) ||
      status.st_uid != ::geteuid() || (status.st_mode & 0137) != 0)
    return std::nullopt;
  char text[kCharacters + 2] = {};
  const ssize_t n = ::pread(file.get(), text, sizeof text, 0);
  if (n != kCharacters + 1 || text[kCharacters] != '\n') return std::nullopt;
  std::string token(text, kCharacters);
  if (!isToken(token)) return std::nullopt;
  return token;
}

Result<Ok> lockToken(const UniqueFd& file, const std::string& path) {
  if (::flock(file.get(), LOCK_EX | LOCK_NB) == 0) return Ok{};
  if (errno != EWOULDBLOCK) return failed(path);
  return Error{Errc::kBusy,
               fmt::format("another merlind already serves this page (it has locked {}); stop it, "
                           "or set another \"instance\"",
                           path)};
}

// Writes the token into a new file, with its mode before its content.
Result<UniqueFd> write(const std::string& path, const std::string& token) {
  UniqueFd file(::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, kMode));
  if (!file.valid()) return failed(path);
  const std::string text = token + "\n";
  if (::fchmod(file.get(), kMode) != 0 ||
      ::write(file.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    return failed(path);
  return file;
}

}  // namespace

Result<TokenFile> TokenFile::open(const std::string& path) {
  // O_NONBLOCK: never waits for a pipe of this name.
  UniqueFd old(::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (old.valid()) {
    if (const auto locked = lockToken(old, path); !locked) return locked.error();
    if (auto token = tokenIn(old)) return TokenFile(path, *std::move(token), std::move(old));
  }
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) return failed(path);
  auto token = newToken();
  if (!token) return token.error();
  auto file = write(path, *token);
  if (!file) return file.error();
  if (const auto locked = lockToken(*file, path); !locked) return locked.error();
  return TokenFile(path, *std::move(token), *std::move(file));
}

}  // namespace merlin::page
