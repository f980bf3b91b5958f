// Which mode, connector and CRTC an output gets. Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/out/kms/card.h"
#include "render/out/kms/settings.h"

namespace merlin::render::out::kms {

// Index of the mode for a picture of this size. `wanted` empty: a mode of the picture's size, the
// preferred or else the fastest one; otherwise the display's preferred mode. Named without a rate:
// the preferred or else the fastest one of that size; with a rate: the nearest one within 0.5 Hz.
// Errors: kNotFound with the modes there are; kInvalidArgument: the picture is larger.
Result<std::size_t> chooseMode(const Connector& connector, const std::string& wanted,
                               int picture_width, int picture_height);

// Index of the connector named `wanted`; empty: the first connected one, or else the first.
// Errors: kNotFound with the connectors there are; `card` is named in it.
Result<std::size_t> chooseConnector(std::span<const Connector> connectors,
                                    const std::string& wanted, const std::string& card);

// For each of `masks`, the CRTCs (bit i: CRTC i) that can drive a connector, the index of one of
// its own; nothing for a connector that gets none. `usable`: bit i: CRTC i has a primary plane.
// As many as possible get one; earlier ones first.
std::vector<std::optional<std::size_t>> assignCrtcs(std::span<const std::uint32_t> masks,
                                                    std::uint32_t usable);

// "640x480@60, 800x600@60 and 5 more": distinct modes, at most `most` of them.
std::string listOf(std::span<const Mode> modes, std::size_t most);
std::string listOf(std::span<const Connector> connectors);

// Writes a picture (RGBA, rows without padding) into the middle of a buffer (BGRX); the rest of the
// buffer is left as it is. REQUIRES: the picture is not larger than the buffer.
void writePicture(std::span<const std::uint8_t> rgba, int width, int height,
                  std::span<std::uint8_t> bgrx, std::size_t pitch, int buffer_width,
                  int buffer_height);

}  // namespace merlin::render::out::kms
