// Text from outside: checks it, and makes it safe to print on a terminal.
#pragma once

#include <string>
#include <string_view>

namespace merlin {

// Whether the bytes are UTF-8 (RFC 3629) without control characters; true if empty.
bool isText(std::string_view bytes) noexcept;

// The bytes without an incomplete character at their end.
std::string_view wholeCharacters(std::string_view bytes) noexcept;

// Escapes control characters except tab and newline, and bytes that are not valid UTF-8, as "\x1b",
// so that a terminal does not interpret them. Other text is unchanged.
std::string printable(std::string_view bytes);

// Like printable(), but also escapes tab and newline ("\x0a"), so that the text stays on one line.
std::string oneLine(std::string_view bytes);

// A text from a file or a peer, shortened for a message: all of it, or "..." after its first 64
// bytes or a few less, so that no character is cut.
std::string excerpt(std::string_view text);

}  // namespace merlin
