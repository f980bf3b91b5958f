// Messages between a window's output in merlind and its program, merlin-window. Each is one packet
// of a socket pair (SOCK_SEQPACKET), of fixed size; both programs are of one build.
//
// merlind sends WindowForm once, then one FrameReady at a time. The program answers each FrameReady
// with a WindowEvent of kind kShown, and sends the other kinds when they happen. The pictures lie
// in memory that both map: PictureSlots.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "daemon/base/panel_pointer.h"

namespace merlin::render::out {

inline constexpr std::uint32_t kWindowMagic = 0x4D574E32;  // +1 with each change of a message

struct WindowForm {
  std::uint32_t magic = kWindowMagic;
  char title[128] = {};  // NUL-terminated, as all texts here
  std::int32_t monitor = 0, x = -1, y = -1, width = 0, height = 0;  // as in WindowSettings
  std::uint8_t fullscreen = 0, border = 1, fit = 1, input = 1;
  std::int32_t picture_width = 0, picture_height = 0;  // [px]
  PanelPointer::Place panel{};  // its place in the picture; width 0: not shown
};

struct FrameReady {
  std::uint32_t slot = 0;  // of PictureSlots; not written to until kShown arrives
};

struct WindowEvent {
  enum Kind : std::uint32_t {
    kOpened = 1,  // the window is there
    kShown = 2,   // the frame of the last FrameReady is in the window
    kClosed = 3,  // a person has closed the window; the program ends
    kFault = 4,   // `text`: why there is no window; the program ends
    kCommand =
        5,  // `text`: a command of daemon/base/commands.h that a person gave: "NAME ARGUMENT"
  };
  Kind kind = kOpened;
  char text[252] = {};
};

static_assert(std::is_trivially_copyable_v<WindowForm> &&
              std::is_trivially_copyable_v<WindowEvent>);

// Copies a text into a field and terminates it; a text that is too long is cut off.
template <std::size_t N>
void copyText(std::string_view from, char (&to)[N]) {
  const std::size_t length = std::min(from.size(), N - 1);
  std::copy_n(from.data(), length, to);
  std::fill(to + length, to + N, '\0');
}

// Returns the text of a field, up to its terminator or, if that is missing, the field's end.
template <std::size_t N>
std::string_view textOf(const char (&field)[N]) {
  return {field, static_cast<std::size_t>(std::find(field, field + N, '\0') - field)};
}

}  // namespace merlin::render::out
