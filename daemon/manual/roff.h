// Text for manual pages, in the macros of man(7).
#pragma once

#include <string>
#include <string_view>

namespace merlin::manual {

// The text as a line of a page: a backslash, and a dot or quotation mark at its beginning, are not
// taken for an instruction; a hyphen that does not join two letters can be copied to a shell.
std::string roffText(std::string_view text);

// The text in bold and in italics. Every '-' becomes "\-", which man shows as an ASCII hyphen, so
// that a command copied from the page works in a shell.
std::string roffBold(std::string_view text);
std::string roffItalic(std::string_view text);

// Lines of text, each but an empty one as a line of the page; "Example: ..." is set apart.
std::string roffLines(std::string_view lines);

// The page's title line. Thread-safe, as all of these.
std::string roffTitle(std::string_view name, int section, std::string_view version);

}  // namespace merlin::manual
