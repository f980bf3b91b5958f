// RfbScreen: the adapter of libvncserver, for one connected client. No other file uses the library.
//
// Everything that the library offers besides pictures and input is switched off: file transfer,
// clipboard, connections to clients, the HTTP server, listening.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "daemon/base/clock.h"
#include "daemon/rfb/input_map.h"
#include "daemon/rfb/view.h"

namespace merlin::rfb {

struct ScreenSettings {
  std::string name;      // shown by clients as their window's title
  std::string password;  // empty: none is asked for
  // Time after which a client is disconnected if it does not send the bytes that are due, or does
  // not read.
  Duration patience = std::chrono::seconds(10);
};

// Thread-bound. Only one may exist at a time, since the library has global variables.
class RfbScreen {
 public:
  // `socket`: a connected client; the library closes it. `input`: where its pointer and keys go;
  // null: they are ignored; must outlive this. `pixels`: RGBA; must stay until it is replaced.
  // REQUIRES: `pixels` has `width` x `height` pixels.
  RfbScreen(int socket, const ScreenSettings& settings, InputMap* input,
            std::span<std::uint8_t> pixels, int width, int height);
  ~RfbScreen();
  RfbScreen(const RfbScreen&) = delete;
  RfbScreen& operator=(const RfbScreen&) = delete;

  // Replaces the picture by another one, which may have another size; the same rules hold for its
  // pixels.
  void setPixels(std::span<std::uint8_t> pixels, int width, int height);
  void markChanged(const Rectangle& rectangle);

  // Waits at most `at_most` for the client, then serves it, which may take up to `patience` for
  // every part of a message.
  void process(Duration at_most);

  bool isGone() const noexcept;         // the client has left, or was disconnected
  bool isEstablished() const noexcept;  // it has completed the handshake
  bool wantsPicture() const noexcept;   // it waits for a change of the picture
  bool gaveWrongPassword() const noexcept;

 private:
  struct Library;
  std::unique_ptr<Library> library_;
};

}  // namespace merlin::rfb
