// Unpacks gzip files (RFC 1952); Open Inventor and VRML files are often compressed like this.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "daemon/base/result.h"

namespace merlin::render::mesh {

bool isGzip(std::string_view bytes) noexcept;

// Returns at most the first `most` bytes of the unpacked content; empty if it is empty or damaged.
std::string gunzipBeginning(std::string_view bytes, std::size_t most);

// Returns the whole unpacked content. Memory grows with what is unpacked; the size that the file
// states is not trusted. Errors, without the file's name: kMalformed (damaged or truncated),
// kUnsupported (more than `most` bytes).
Result<std::string> gunzip(std::string_view bytes, std::size_t most);

// Returns the error with which a reader that does not unpack files refuses a packed one, without
// the file's name: kMalformed (damaged, with the position, or truncated), else kUnsupported, which
// says what to do instead. Unpacks up to 1 GiB, but keeps nothing. REQUIRES: isGzip(bytes).
Error packedFileError(std::string_view bytes);

}  // namespace merlin::render::mesh
