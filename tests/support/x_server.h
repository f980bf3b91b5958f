// XServer: an X server without a screen (Xvfb), started by a test, and the actions of a person who
// uses it. Each call opens a connection of its own, since Xlib ends a process when the server of an
// open connection goes away.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// clang-format off
#include <gtest/gtest.h>  // before Xlib, since Xlib's macros break this header
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>
#include <fmt/format.h>
#include <unistd.h>
// clang-format on

#include "tests/support/pictures.h"
#include "tests/support/process.h"

namespace merlin::test {

class XServer {
 public:
  XServer() { start(); }

  // For example ":99"; the value of the environment variable DISPLAY.
  const std::string& display() const { return display_; }
  Process& process() { return *process_; }

  // Starts the server; once it has ended, starts it again with the same display number.
  void start() {
    process_ = std::make_unique<Process>(
        std::vector<std::string>{"Xvfb", display_, "-displayfd", "1", "-screen", "0",
                                 "1600x1200x24", "-nolisten", "tcp", "-noreset"});
    const auto number = [&] {
      const std::string said = process_->output();
      const std::size_t end = said.rfind('\n');
      if (end == std::string::npos) return std::string();
      const std::size_t begin = said.rfind('\n', end - 1);
      const std::string line = said.substr(begin + 1, end - begin - 1);
      const bool whole = !line.empty() && line.find_first_not_of("0123456789") == std::string::npos;
      return whole ? line : std::string();
    };
    ASSERT_TRUE(eventually([&] { return !number().empty() || process_->ended(); }))
        << process_->output();
    ASSERT_EQ(":" + number(), display_) << process_->output();
  }

  // The pixels of the screen.
  Image screenshot() const {
    const Connection x(display_);
    if (!x.open()) return {};
    XWindowAttributes root{};
    XGetWindowAttributes(x.get(), x.root(), &root);
    XImage* const from = XGetImage(x.get(), x.root(), 0, 0, static_cast<unsigned>(root.width),
                                   static_cast<unsigned>(root.height), AllPlanes, ZPixmap);
    Image image{root.width, root.height, {}};
    for (int y = 0; y < image.height; ++y) {
      for (int column = 0; column < image.width; ++column) {
        const unsigned long p = XGetPixel(from, column, y);
        for (const int shift : {16, 8, 0})
          image.pixels.push_back(static_cast<std::uint8_t>(p >> shift));
        image.pixels.push_back(255);
      }
    }
    XDestroyImage(from);
    return image;
  }

  bool hasWindow(const std::string& title) const {
    const Connection x(display_);
    return x.open() && x.find(title);
  }

  // Closes the window as a window manager does when a person clicks on its close button.
  void close(const std::string& title) const {
    const Connection x(display_);
    const std::optional<Window> window = x.find(title);
    ASSERT_TRUE(window);
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = *window;
    event.xclient.message_type = XInternAtom(x.get(), "WM_PROTOCOLS", 0);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(XInternAtom(x.get(), "WM_DELETE_WINDOW", 0));
    XSendEvent(x.get(), *window, 0, NoEventMask, &event);
    XSync(x.get(), 0);
  }

  // Presses and releases a key in the window; `key` is a keysym such as XK_m.
  void key(const std::string& title, KeySym key) const {
    const Connection x(display_);
    const std::optional<Window> window = x.find(title);
    ASSERT_TRUE(window);
    XSetInputFocus(x.get(), *window, RevertToParent, CurrentTime);
    const KeyCode code = XKeysymToKeycode(x.get(), key);
    XTestFakeKeyEvent(x.get(), code, 1, CurrentTime);
    XTestFakeKeyEvent(x.get(), code, 0, CurrentTime);
    XSync(x.get(), 0);
  }

  // Moves the pointer from `from` by `by`, both (x, y), in five steps, with the button held down.
  void drag(unsigned button, std::pair<int, int> from, std::pair<int, int> by) const {
    const Connection x(display_);
    XTestFakeMotionEvent(x.get(), 0, from.first, from.second, CurrentTime);
    XTestFakeButtonEvent(x.get(), button, 1, CurrentTime);
    for (int i = 1; i <= 5; ++i) {
      XTestFakeMotionEvent(x.get(), 0, from.first + by.first * i / 5,
                           from.second + by.second * i / 5, CurrentTime);
    }
    XTestFakeButtonEvent(x.get(), button, 0, CurrentTime);
    XSync(x.get(), 0);
  }

 private:
  class Connection {
   public:
    explicit Connection(const std::string& display) : display_(XOpenDisplay(display.c_str())) {}
    ~Connection() {
      if (display_) XCloseDisplay(display_);
    }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    bool open() const { return display_ != nullptr; }
    Display* get() const { return display_; }
    Window root() const { return DefaultRootWindow(display_); }
    std::optional<Window> find(const std::string& title) const {
      Window root_window = 0, parent = 0, *children = nullptr;
      unsigned count = 0;
      std::optional<Window> found;
      if (XQueryTree(display_, root(), &root_window, &parent, &children, &count) == 0) return found;
      for (unsigned i = 0; i < count; ++i) {
        char* name = nullptr;
        if (XFetchName(display_, children[i], &name) == 0) continue;
        if (name == title) found = children[i];
        XFree(name);
      }
      if (children) XFree(children);
      return found;
    }

   private:
    Display* display_;
  };

  // A display number derived from the process id. If Xvfb chose a free number, another test's
  // server could take that number while this server is down. Displays may go up to 59535, since
  // their TCP ports begin at 6000.
  std::string display_ = fmt::format(":{}", 1000 + getpid() % 50000);
  std::unique_ptr<Process> process_;
};

}  // namespace merlin::test
