// Chooses the mode, connector and CRTC of an output, and copies a picture into a display's buffer.
// Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/out/kms/card.h"
#include "render/out/kms/settings.h"

namespace merlin::render::out::kms {

// Returns the index in connector.modes of the mode for a picture of this size [px]. `wanted` is
// WIDTHxHEIGHT@HZ (of the modes of that size, the one with the nearest rate, less than 0.5 Hz
// away), WIDTHxHEIGHT (the preferred, or else the fastest mode of that size), or empty. If it is
// empty, the preferred, or else the fastest progressive mode of the picture's size is chosen; if
// there is none, the display's preferred mode, or else its first. Errors: kNotFound, with a list of
// the modes; kInvalidArgument: the picture is larger than the mode.
Result<std::size_t> chooseMode(const Connector& connector, const std::string& wanted,
                               int picture_width, int picture_height);

// Returns the index of the connector named `wanted`; if `wanted` is empty, of the first connector
// with a display, or else of the first one. Errors: kNotFound; the message has the name `card` and
// lists the connectors.
Result<std::size_t> chooseConnector(std::span<const Connector> connectors,
                                    const std::string& wanted, const std::string& card);

// Assigns each connector a CRTC of its own. `masks`: for each connector, the CRTCs that can drive
// it (bit i: CRTC i). `usable`: the CRTCs that have a primary plane (bit i: CRTC i). Returns a
// CRTC's index for each connector, nothing for one that gets none.
// As many connectors as possible get one; earlier ones first.
std::vector<std::optional<std::size_t>> assignCrtcs(std::span<const std::uint32_t> masks,
                                                    std::uint32_t usable);

// Lists modes for a message, as in "640x480@60, 800x600@60 and 5 more": each name once, and at most
// `most` names.
std::string listOf(std::span<const Mode> modes, std::size_t most);
std::string listOf(std::span<const Connector> connectors);

// Position of a picture's upper left pixel in the larger picture in whose middle it lies [px].
struct Corner {
  int x = 0, y = 0;
};
constexpr Corner middle(int width, int height, int outer_width, int outer_height) {
  return {(outer_width - width) / 2, (outer_height - height) / 2};
}

// Writes a picture (RGBA, rows without padding) into the middle of a buffer (BGRX); the rest of the
// buffer is left as it is. `pitch`: from one row of the buffer to the next [bytes]. REQUIRES: the
// picture is not larger than the buffer.
void writePicture(std::span<const std::uint8_t> rgba, int width, int height,
                  std::span<std::uint8_t> bgrx, std::size_t pitch, int buffer_width,
                  int buffer_height);

}  // namespace merlin::render::out::kms
