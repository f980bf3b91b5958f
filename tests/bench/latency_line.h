// The device's end of a line in a latency benchmark: the driver's opening dialogue, and records at
// times that no reader can predict.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "drivers/emulate/emulator.h"

namespace merlin::bench {

// Requests real-time priority for the calling thread; returns false if that is not allowed.
bool askForRealTime();

// Lets the emulator answer the driver's queries on the line until `done` returns true. `fd`: the
// device's end of the line, non-blocking.
void serveDialogue(int fd, emulate::Emulator& emulator, const std::function<bool()>& done);

// Sends `greeting` on the line, then discards what is received there until `done` returns true.
void serveGreeting(int fd, const std::string& greeting, const std::function<bool()>& done);

// Calls `send` with 0, 1 ... `count` - 1, at irregular intervals around the rate, so that no loop
// can synchronise with them.
void atIrregularTimes(std::uint32_t count, double rate_hz,
                      const std::function<void(std::uint32_t n)>& send);

}  // namespace merlin::bench
