// The page's token: a secret in a file that the daemon's user and group can read.
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "daemon/base/unique_fd.h"

namespace merlin::page {

// The token's file stays open and locked while this exists, so that no other page of this instance
// starts.
class TokenFile {
 public:
  // Keeps the token that the file holds, so that browsers need no new one after a restart, or makes
  // a new one: 32 characters of 64 (192 bits) from the system's random numbers, mode 0640. A file
  // that another user owns, that others could have read or written, or that holds anything else is
  // replaced. Errors: kBusy (a running process has locked it), kIo.
  static Result<TokenFile> open(const std::string& path);

  const std::string& token() const noexcept { return token_; }
  const std::string& path() const noexcept { return path_; }

 private:
  TokenFile(std::string path, std::string token, UniqueFd file)
      : path_(std::move(path)), token_(std::move(token)), file_(std::move(file)) {}

  std::string path_, token_;
  UniqueFd file_;
};

}  // namespace merlin::page
