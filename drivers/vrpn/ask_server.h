// The dialogue with a VRPN server of which nothing is known: which devices does it have?
#pragma once

#include "daemon/base/clock.h"
#include "drivers/port/byte_stream.h"
#include "drivers/vrpn/catalog.h"

namespace merlin::vrpn {

// Greets the server and fills `catalog`, which is new, with what it sends until `until`. A server
// describes its devices at once, but what they measure is seen only when they send something, so
// there is no end before that moment, unless the server has sent 1 MiB. The connection can serve
// for nothing else. Errors: kTimeout (no greeting by then), those of Catalog::take() and of the
// stream; the catalog has what came before.
Result<Ok> askServer(ByteStream& stream, const Clock& clock, Timestamp until, Catalog& catalog);

}  // namespace merlin::vrpn
