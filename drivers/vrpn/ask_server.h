// Asks a VRPN server about which nothing is known for a list of its devices.
#pragma once

#include "daemon/base/clock.h"
#include "drivers/port/byte_stream.h"
#include "drivers/vrpn/catalog.h"

namespace merlin::vrpn {

// Greets the server and fills `catalog`, which must be empty, from the messages that the server
// sends until `until`. A server describes its devices at once, but what a device measures is known
// only when it sends something, so the call always lasts until then, unless the server has sent 1
// MiB. The connection cannot be used for anything else afterwards. Errors: kTimeout (no greeting by
// then), those of Catalog::take() and of the stream; the catalog keeps what arrived before the
// error.
Result<Ok> askServer(ByteStream& stream, const Clock& clock, Timestamp until, Catalog& catalog);

}  // namespace merlin::vrpn
