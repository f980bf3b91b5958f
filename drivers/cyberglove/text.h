// CyberGlove wire format, ASCII dialogue: the same commands, answers and records with lower-case
// letters and decimal numbers between blanks. No I/O, no clock.
//
//   "n 22" CR   sets; "?n" CR asks; "n" CR LF NUL and "?n 22" CR LF NUL answer
//   's' or 'g' v1 .. vN [time stamp] [status] ["es"] ["eg"] CR LF NUL is a record
//
// Commands and the values of a record are taken from FREEVR and VISTA; answers, and the optional
// fields of a record, are inferred from the binary dialogue (README.md).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "drivers/cyberglove/protocol.h"

namespace merlin::cyberglove {

// Convert a binary command or answer to text, and back; both without terminators. Numbers are
// bytes; `T` has two 16-bit words. Control characters, and queries that are text in both dialogues
// ("?i", "?v", "??"), are unchanged. ofText() returns nothing if the text is not a letter followed
// by numbers in range.
std::string asText(std::string_view binary);
std::optional<std::string> ofText(std::string_view text);

// Returns whether `command`, which may be incomplete, belongs to the ASCII dialogue and thus ends
// with CR.
bool isText(std::string_view command) noexcept;

// Parses a packet, which is passed without its NUL; returns nothing if it does not fit `layout`.
// Allocates nothing.
std::optional<Packet> readText(std::string_view text, const Layout& layout) noexcept;
// Returns the text of a record with its terminators CR LF NUL. A value of 0 is sent as 1.
std::string encodeText(const Record& record, const Layout& layout);

}  // namespace merlin::cyberglove
