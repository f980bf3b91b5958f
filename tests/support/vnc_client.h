// VncClient: a real VNC client, libvncclient, for tests of merlin-rfb.
#pragma once

#include <chrono>
#include <cstring>
#include <functional>
#include <string>

#include <gtest/gtest.h>
#include <rfb/rfbclient.h>

#include "tests/support/eventually.h"
#include "tests/support/pictures.h"

namespace merlin::test {

class VncClient {
 public:
  explicit VncClient(int port, const std::string& password = "") {
    rfbClientLog = rfbClientErr = dropLine;
    client_ = rfbGetClient(8, 3, 4);
    rfbClientSetClientData(client_, nullptr, this);
    client_->serverHost = ::strdup("127.0.0.1");
    client_->serverPort = port;
    client_->canHandleNewFBSize = TRUE;
    // Raw pixels are exact, and these tests need no other encoding.
    client_->appData.encodingsString = "raw";
    password_ = password;
    client_->GetPassword = [](rfbClient* c) {
      return ::strdup(
          static_cast<VncClient*>(rfbClientGetClientData(c, nullptr))->password_.c_str());
    };
    client_->FinishedFrameBufferUpdate = [](rfbClient* c) {
      ++static_cast<VncClient*>(rfbClientGetClientData(c, nullptr))->updates_;
    };
    // rfbInitClient() frees the client when it fails
    if (!rfbInitClient(client_, nullptr, nullptr)) client_ = nullptr;
  }
  ~VncClient() {
    if (client_) rfbClientCleanup(client_);
  }
  VncClient(const VncClient&) = delete;
  VncClient& operator=(const VncClient&) = delete;

  bool isConnected() const { return client_ != nullptr; }
  std::string name() const { return client_->desktopName; }
  int updates() const { return updates_; }

  // Handles messages of the server until `condition` is true; false if the deadline passes or the
  // server closes the connection.
  bool until(const std::function<bool()>& condition,
             std::chrono::seconds deadline = std::chrono::seconds(120)) {
    bool open = true;
    const auto take = [&] {
      const int ready = WaitForMessage(client_, 10'000);  // microseconds
      open = ready >= 0 && (ready == 0 || HandleRFBServerMessage(client_));
      return !open || condition();
    };
    return eventually(take, deadline) && open;
  }
  // Requests the whole picture and waits until it has arrived. By then the server has handled
  // everything that was sent to it before.
  bool refresh() {
    const int before = updates_;
    SendFramebufferUpdateRequest(client_, 0, 0, client_->width, client_->height, FALSE);
    return until([&] { return updates_ > before; });
  }
  Image picture() const {
    Image image{client_->width, client_->height, {}};
    const auto bytes = static_cast<std::size_t>(4 * image.width * image.height);
    image.pixels.assign(client_->frameBuffer, client_->frameBuffer + bytes);
    return image;
  }
  bool shows(const Image& image) {
    return until([&] {
      return client_->width == image.width && client_->height == image.height &&
             differing(picture(), image, 0) == 0;
    });
  }

  void pointer(int buttons, int x, int y) { SendPointerEvent(client_, x, y, buttons); }
  void press(std::uint32_t keysym) {
    SendKeyEvent(client_, keysym, TRUE);
    SendKeyEvent(client_, keysym, FALSE);
  }

 private:
  static void dropLine(const char* /*format*/, ...) {}

  rfbClient* client_ = nullptr;
  std::string password_;
  int updates_ = 0;
};

}  // namespace merlin::test
