// Routes: what a request asks for, after its path, method and content were checked. Pure.
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
  std::uint64_t content = 0;  // its place in the list of contents
};
// A code by which a phone opens the page.
struct PhoneRoute {
  std::string origin;  // of the page, as the browser sees it; empty: it does not say
};
struct CommandRoute {
  const CommandInfo* command;
  std::string argument;
};
// An Answer: the request is answered already, or refused.
using Route = std::variant<Answer, FileRoute, StatusRoute, CommandListRoute, EventsRoute,
                           FramesRoute, MetricsRoute, PictureRoute, ContentsRoute, ThumbnailRoute,
                           PhoneRoute, CommandRoute>;

inline constexpr int kPictureWidths[] = {320, 640, 960, 1280, 1920};

// Checks the request (gate.h) and finds what it asks for.
Route route(const Request& request, const RouteSettings& settings);

// Whether the page may send a command: those that `merlin NAME` sends, those that inputs may be
// bound to once, and those that the page has controls of its own for.
bool isPageCommand(const CommandInfo& command);

}  // namespace merlin::page
