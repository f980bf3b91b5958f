// Names of hosts in HTTP headers, and the check whether they are the page's own. Pure.
//
// In an attack by DNS rebinding, another site's name is given the address of this machine, and the
// browser sends that name as Host. So only addresses, which cannot be rebound, localhost and the
// configured names are accepted.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace merlin::page {

// Whether the text has only letters, digits, '-' and dots, and at most 253 of them.
bool isHostName(std::string_view name);

// Returns the words of a text, which are separated by spaces.
std::vector<std::string> wordsOf(std::string_view text);

// Returns the host of "HOST" or "HOST:PORT", in lower case, and an IPv6 address without its
// brackets. Returns nothing if the text is malformed.
std::optional<std::string> hostOf(std::string_view authority);

// Whether this host, as hostOf() returns it, means the machine that the browser runs on.
bool isLoopbackHost(std::string_view host);

// Whether the host is an address, localhost, or one of `names`.
bool isOwnHost(std::string_view host, std::span<const std::string> names);

}  // namespace merlin::page
