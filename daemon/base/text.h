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

}  // namespace merlin
