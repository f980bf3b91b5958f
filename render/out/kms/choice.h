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

// Returns the index of the mode for a picture of this size. If `wanted` is empty, this is a mode of
// the picture's size (the preferred one, or else the fastest), or if there is none, the display's
// preferred mode. If `wanted` has no rate: the preferred or else the fastest mode of the wanted
// size. If it has a rate: the mode of that size whose rate is nearest, within 0.5 Hz. Errors:
// kNotFound, with a list of the modes; kInvalidArgument: the picture is larger than the mode.
Result<std::size_t> chooseMode(const Connector& connector, const std::string& wanted,
                               int picture_width, int picture_height);

// Index of the connector named `wanted`; empty: the first connected one, or else the first.
// Errors: kNotFound, with the name `card` and a list of its connectors.
Result<std::size_t> chooseConnector(std::span<const Connector> connectors,
                                    const std::string& wanted, const std::string& card);

// Assigns each connector a CRTC of its own. `masks`: for each connector, the CRTCs that can drive
// it (bit i: CRTC i). `usable`: the CRTCs that have a primary plane (bit i: CRTC i). Returns a
// CRTC's index for each connector, nothing for one that gets none.
// As many connectors as possible get one; earlier ones first.
std::vector<std::optional<std::size_t>> assignCrtcs(std::span<const std::uint32_t> masks,
                                                    std::uint32_t usable);

// "640x480@60, 800x600@60 and 5 more": distinct modes, at most `most` of them.
std::string listOf(std::span<const Mode> modes, std::size_t most);
std::string listOf(std::span<const Connector> connectors);

// Where the upper left pixel of a picture is that lies in the middle of a larger one [px].
struct Corner {
  int x = 0, y = 0;
};
constexpr Corner middle(int width, int height, int outer_width, int outer_height) {
  return {(outer_width - width) / 2, (outer_height - height) / 2};
}

// Writes a picture (RGBA, rows without padding) into the middle of a buffer (BGRX); the rest of the
// buffer is left as it is. REQUIRES: the picture is not larger than the buffer.
void writePicture(std::span<const std::uint8_t> rgba, int width, int height,
                  std::span<std::uint8_t> bgrx, std::size_t pitch, int buffer_width,
                  int buffer_height);

}  // namespace merlin::render::out::kms
