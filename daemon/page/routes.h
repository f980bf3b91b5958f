// Routes: finds what a request asks for, and checks its path, method, token and content. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "daemon/base/commands.h"
#include "daemon/page/exchange.h"
#include "daemon/page/gate.h"
#include "daemon/page/page_files.h"

namespace merlin::page {

struct RouteSettings {
  GateSettings gate;
  bool page = true, metrics = true;  // what is served
};

struct FileRoute {
  const PageFile* file;
};
struct StatusRoute {};
struct CommandListRoute {};
struct EventsRoute {
  std::uint64_t since = 0;  // number of the last event that the client has; 0: none
};
struct FramesRoute {
  std::uint64_t since = 0;  // number of the last frame that the client has; 0: none
};
struct MetricsRoute {};
struct PictureRoute {
  std::string view = "wall";  // "wall", "operator", or "tile NAME"
  int width = 960;            // at most, one of kPictureWidths [px]
  std::uint64_t after = 0;    // number of the picture that the client has; 0: none
};
struct ContentsRoute {};
struct ThumbnailRoute {
  std::uint64_t content = 0;  // place of the content: see Thumbnails::jpeg()
};
// The QR code with which a phone opens the page.
struct PhoneRoute {
  std::string origin;  // the page's origin as the browser sends it; empty: it sends none
};
struct CommandRoute {
  const CommandInfo* command;
  std::string argument;
};
// What a request asks for. An Answer means that the request is answered already, or refused.
using Route = std::variant<Answer, FileRoute, StatusRoute, CommandListRoute, EventsRoute,
                           FramesRoute, MetricsRoute, PictureRoute, ContentsRoute, ThumbnailRoute,
                           PhoneRoute, CommandRoute>;

inline constexpr int kPictureWidths[] = {320, 640, 960, 1280, 1920};

// Checks the request (gate.h) and finds what it asks for.
Route route(const Request& request, const RouteSettings& settings);

// Whether the page may send a command: true for those that `merlin NAME` sends, those that inputs
// may be bound to with Bindable::kOnce, and those for which the page has controls of its own.
bool isPageCommand(const CommandInfo& command);

}  // namespace merlin::page
