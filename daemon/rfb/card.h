// The picture that VNC clients see while there is no wall: a text that says what is missing. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace merlin::rfb {

// Fills `canvas` (RGBA, `width` x `height` pixels) with grey and writes `text` in the middle. Each
// line of `text` begins a new line; a line that is too long is broken between words.
void drawCard(std::string_view text, std::span<std::uint8_t> canvas, int width, int height);

}  // namespace merlin::rfb
