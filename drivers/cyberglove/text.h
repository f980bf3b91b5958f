// CyberGlove wire format, ASCII dialogue: the same commands, answers and records with lower-case
// letters and decimal numbers between blanks. No I/O, no clock.
//
//   "n 22" CR   sets; "?n" CR asks; "n" CR LF NUL and "?n 22" CR LF NUL answer
//   's' or 'g' v1 .. vN [time stamp] [status] ["es"] ["eg"] CR LF NUL is a record
//
// Commands and the record's values are FREEVR's and VISTA's; answers, and the optional parts of a
// record, are inferred from the binary ones (README.md).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "drivers/cyberglove/protocol.h"

namespace merlin::cyberglove {

// A binary command or answer as text, and back; both without what ends them. Numbers are bytes, of
// `T` two 16-bit words. Control characters, and what is text in both dialogues ("?i", "?v", "??"),
// stay as they are. nullopt: not a letter and numbers in range.
std::string asText(std::string_view binary);
std::optional<std::string> ofText(std::string_view text);

// True where `command`, so far, belongs to the ASCII dialogue, and so ends with CR.
bool isText(std::string_view command) noexcept;

// `text` is a packet without its NUL. Allocates nothing.
std::optional<Packet> readText(std::string_view text, const Layout& layout) noexcept;
std::string encodeText(const Record& record, const Layout& layout);

}  // namespace merlin::cyberglove
