#include "daemon/rfb/rfb_screen.h"

#include <stdexcept>
#include <utility>

#include <rfb/rfb.h>
#include <unistd.h>
extern "C" {  // the header lacks this declaration
#include <rfb/rfbregion.h>
}

namespace merlin::rfb {
namespace {

// Delay after each wrong password. It limits guessing to a few attempts per second over all places.
constexpr unsigned kWrongPassword_s = 2;

void dropLine(const char* /*format*/, ...) {}

}  // namespace

struct RfbScreen::Library {
  std::string name, password;
  char* passwords[2] = {nullptr, nullptr};  // a list, ended by a null pointer
  InputMap* input = nullptr;
  rfbScreenInfoPtr screen = nullptr;
  rfbClientPtr client = nullptr;  // null before it is accepted, and after it has left
  bool gone = false, wrong_password = false;

  static Library& of(rfbClientPtr client) {
    return *static_cast<Library*>(client->screen->screenData);
  }
  void setUp(const ScreenSettings& settings);
  void setHooks();
};

void RfbScreen::Library::setUp(const ScreenSettings& settings) {
  name = settings.name;
  password = settings.password;
  screen->screenData = this;
  screen->desktopName = name.c_str();
  screen->port = screen->ipv6port = 0;  // with an inetd socket: the library does not listen
  screen->autoPort = FALSE;
  screen->httpDir = nullptr;
  screen->permitFileTransfer = FALSE;
  screen->alwaysShared = TRUE;  // each client has a process of its own and disturbs no other
  screen->cursor = nullptr;     // the library would draw one into the picture
  screen->deferUpdateTime = 0;
  screen->depth = screen->serverFormat.depth = 24;  // the fourth byte means nothing
  screen->maxClientWait = static_cast<int>(settings.patience / std::chrono::milliseconds(1));
  if (!password.empty()) {
    passwords[0] = password.data();
    screen->authPasswdData = passwords;
    screen->authPasswdFirstViewOnly = 1;
  }
}

void RfbScreen::Library::setHooks() {
  screen->newClientHook = [](rfbClientPtr newcomer) {
    Library& library = of(newcomer);
    library.client = newcomer;
    newcomer->viewOnly = library.input ? FALSE : TRUE;
    newcomer->clientGoneHook = [](rfbClientPtr leaving) {
      of(leaving).client = nullptr;
      of(leaving).gone = true;
    };
    return RFB_CLIENT_ACCEPT;
  };
  if (!password.empty()) {
    screen->passwordCheck = [](rfbClientPtr from, const char* response, int length) -> rfbBool {
      if (rfbCheckPasswordByList(from, response, length)) return TRUE;
      of(from).wrong_password = true;
      ::sleep(kWrongPassword_s);
      return FALSE;
    };
  }
  screen->ptrAddEvent = [](int buttons, int x, int y, rfbClientPtr from) {
    InputMap* const map = of(from).input;
    if (map) map->pointer(static_cast<unsigned>(buttons), x, y, from->screen->height);
  };
  screen->kbdAddEvent = [](rfbBool down, rfbKeySym key, rfbClientPtr from) {
    InputMap* const map = of(from).input;
    if (map) map->key(static_cast<std::uint32_t>(key), down != 0);
  };
  screen->setXCutText = [](char*, int, rfbClientPtr) {};
}

RfbScreen::RfbScreen(int socket, const ScreenSettings& settings, InputMap* input,
                     std::span<std::uint8_t> pixels, int width, int height)
    : library_(std::make_unique<Library>()) {
  // Discards the library's log lines, which repeat what clients send. The parent process reports
  // how each client's connection ended.
  rfbLog = rfbErr = dropLine;
  Library& l = *library_;
  l.input = input;
  l.screen = rfbGetScreen(nullptr, nullptr, width, height, 8, 3, 4);
  if (!l.screen) throw std::bad_alloc();
  l.setUp(settings);
  l.setHooks();
  l.screen->frameBuffer = reinterpret_cast<char*>(pixels.data());
  l.screen->inetdSock = socket;
  rfbInitServer(l.screen);
}

RfbScreen::~RfbScreen() {
  library_->screen->frameBuffer = nullptr;  // the library must not free it
  rfbScreenCleanup(library_->screen);
}

void RfbScreen::setPixels(std::span<std::uint8_t> pixels, int width, int height) {
  rfbNewFramebuffer(library_->screen, reinterpret_cast<char*>(pixels.data()), width, height, 8, 3,
                    4);
}

void RfbScreen::markChanged(const Rectangle& r) {
  rfbMarkRectAsModified(library_->screen, r.x, r.y, r.x + r.width, r.y + r.height);
}

void RfbScreen::process(Duration at_most) {
  rfbProcessEvents(library_->screen, static_cast<long>(at_most / std::chrono::microseconds(1)));
}

bool RfbScreen::isGone() const noexcept { return library_->gone; }

bool RfbScreen::isEstablished() const noexcept {
  return library_->client && library_->client->state == rfbClientRec::RFB_NORMAL;
}

bool RfbScreen::wantsPicture() const noexcept {
  return library_->client && !sraRgnEmpty(library_->client->requestedRegion);
}

bool RfbScreen::gaveWrongPassword() const noexcept { return library_->wrong_password; }

}  // namespace merlin::rfb
