#include "render/text/font_file.h"

// The assembler includes the font file, so that the compiler need not parse 760,000 bytes.
asm(".pushsection .rodata\n"
    ".balign 16\n"
    ".global merlin_font_begin\n"
    ".global merlin_font_end\n"
    "merlin_font_begin:\n"
    ".incbin \"" MERLIN_FONT_FILE
    "\"\n"
    "merlin_font_end:\n"
    ".byte 0\n"
    ".popsection\n");

extern "C" {
extern const std::byte merlin_font_begin[];
extern const std::byte merlin_font_end[];
}

namespace merlin::render::text {

std::span<const std::byte> fontFile() noexcept {
  return {merlin_font_begin, static_cast<std::size_t>(merlin_font_end - merlin_font_begin)};
}

}  // namespace merlin::render::text
