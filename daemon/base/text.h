// Text from outside: what may be a name, and what may be shown on a terminal.
#pragma once

#include <string>
#include <string_view>

namespace merlin {

// Whether it is UTF-8 (RFC 3629) without control characters. Empty is text.
bool isText(std::string_view bytes) noexcept;

// Without what is at its end of a character that was cut off there.
std::string_view wholeCharacters(std::string_view bytes) noexcept;

// With control characters (all but tabs and ends of lines) and bytes that are no UTF-8 as "\x1b": a
// terminal would follow them. Plain text stays as it is.
std::string printable(std::string_view bytes);

// The same, with tabs and ends of lines as "\x0a" too: what is said of one thing stays one line.
std::string oneLine(std::string_view bytes);

// What a message quotes of a file or a peer: all of it, or its first 64 bytes or a few less (no
// character is cut) and "...". A word there may be as long as the file.
std::string excerpt(std::string_view text);

}  // namespace merlin
