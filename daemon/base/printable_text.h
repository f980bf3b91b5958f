// Text from outside: checks it, and makes it safe to print on a terminal.
#pragma once

#include <string>
#include <string_view>

namespace merlin {

// Whether the bytes are UTF-8 (RFC 3629) without control characters; true if empty.
bool isText(std::string_view bytes) noexcept;

// Returns the bytes without the first bytes of a UTF-8 character that the end cuts. Whatever stands
// before them is kept.
std::string_view wholeCharacters(std::string_view bytes) noexcept;

// Escapes control characters except tab and newline, and bytes that are not valid UTF-8, as "\x1b",
// so that a terminal does not interpret them. Other text is unchanged.
std::string printable(std::string_view bytes);

// Like printable(), but also escapes tab and newline ("\x0a"), so that the text stays on one line.
std::string oneLine(std::string_view bytes);

// Shortens a text from a file or a peer for a message. A text of more than 64 bytes is cut after 64
// bytes, or up to 3 less so that no character is cut, and gets "..." at its end.
std::string excerpt(std::string_view text);

}  // namespace merlin
