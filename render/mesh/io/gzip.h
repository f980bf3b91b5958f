// Unpacks gzip files (RFC 1952); Open Inventor and VRML files are often compressed like this.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "daemon/base/result.h"

namespace merlin::render::mesh {

bool isGzip(std::string_view bytes) noexcept;

// Returns at most the first `most` bytes of the unpacked content; fewer, down to none, if the
// content is shorter or damaged.
std::string gunzipBeginning(std::string_view bytes, std::size_t most);

// Returns the whole unpacked content. Memory grows with the unpacked data; the size that the file
// declares is not trusted. Errors, without the file's name: kMalformed (damaged or truncated),
// kUnsupported (more than `most` bytes).
Result<std::string> gunzip(std::string_view bytes, std::size_t most);

// Returns the error with which a reader that does not support packed files refuses one, without the
// file's name. The code is kMalformed if the file is damaged or truncated; otherwise it is
// kUnsupported, with advice on how to unpack the file. Unpacks up to 1 GiB for this check, but
// keeps nothing. REQUIRES: isGzip(bytes).
Error packedFileError(std::string_view bytes);

}  // namespace merlin::render::mesh
