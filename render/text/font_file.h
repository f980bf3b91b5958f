// The font that MERLIN draws text with, embedded in the program (font/DejaVuSans.ttf).
#pragma once

#include <cstddef>
#include <span>

namespace merlin::render::text {

std::span<const std::byte> fontFile() noexcept;

}  // namespace merlin::render::text
