// merlin-rfb: shows the wall to VNC clients. main(): reads the command line and runs the server.
#include <algorithm>
#include <csignal>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <sys/resource.h>

#include "daemon/base/log.h"
#include "daemon/base/printable_text.h"
#include "daemon/base/version.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/parse_arguments.h"
#include "daemon/cli/stop_signals.h"
#include "daemon/rfb/rfb_server.h"
#include "daemon/rfb/shown_picture.h"

namespace merlin {
namespace {

// Nice value of this program, so that the wall's threads take precedence on a busy machine.
constexpr int kNice = 10;

struct Options {
  rfb::RfbSettings settings;
  std::string listen = "127.0.0.1:5900", password_file, view = "wall", tile;
};

void addOptions(CLI::App& app, Options& o) {
  app.add_option("--listen", o.listen,
                 "Where VNC clients connect; an address that other machines can reach needs a "
                 "password")
      ->type_name("ADDRESS:PORT")
      ->capture_default_str();
  app.add_option("--password-file", o.password_file,
                 "File whose first line is the password, 1 to 8 characters; readable by its owner "
                 "only (mode 0600)")
      ->type_name("FILE");
  CLI::Option* const view =
      app.add_option("--view", o.view,
                     "What clients see: the wall's tiles side by side, or the operator's view")
          ->check(CLI::IsMember({"wall", "operator"}))
          ->capture_default_str();
  app.add_option("--tile", o.tile,
                 "Clients see this tile instead; merlin wall plan lists the tiles")
      ->type_name("NAME")
      ->excludes(view);
  app.add_flag("--allow-input", o.settings.allow_input,
               "Pointer and keys of clients move the model; without it clients only look");
  app.add_option("--clients", o.settings.clients, "Maximum number of clients at a time")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--rate", o.settings.rate_hz,
                 "Maximum number of pictures per second for each client")
      ->type_name("HZ")
      ->check(CLI::Range(1, 60))
      ->capture_default_str();
  app.add_option("--instance", o.settings.instance,
                 "Name of the daemon: the setting instance of its configuration")
      ->capture_default_str();
}

Result<Ok> complete(Options& o) {
  const auto listen = rfb::parseListen(o.listen);
  if (!listen) return listen.error();
  o.settings.listen = *listen;
  using Kind = rfb::View::Kind;
  o.settings.view.kind = o.view == "operator" ? Kind::kOperator : Kind::kWall;
  if (!o.tile.empty()) o.settings.view = {Kind::kTile, o.tile};
  if (o.password_file.empty()) return Ok{};
  const auto password = rfb::readPassword(o.password_file);
  if (!password) return Error{password.error().code, "--password-file " + password.error().what};
  o.settings.password = *password;
  return Ok{};
}

int fail(const Error& error) {
  printError("merlin-rfb: {}\n", printable(error.what));
  return exitStatus(error);
}

// Logs at the start the message that clients would see instead of the wall: no wall, no permission,
// no such tile.
void warnOfCard(const rfb::RfbSettings& settings) {
  rfb::ShownPicture picture(settings.instance, settings.view, SharedMemory::From::kOwnGroup);
  picture.update(SystemClock().now());
  std::string card = picture.card();
  std::replace(card.begin(), card.end(), '\n', ' ');
  if (!card.empty()) logWarning("for now clients see only this message: {}", oneLine(card));
}

int serve(Options& options) {
  if (const auto completed = complete(options); !completed) return fail(completed.error());
  const UniqueFd stop = cli::stopSignals();
  auto server = rfb::RfbServer::make(options.settings);
  if (!server) return fail(server.error());
  std::signal(SIGPIPE, SIG_IGN);
  ::setpriority(PRIO_PROCESS, 0, kNice);
  initLog(LogLevel::kInfo);
  const rfb::RfbSettings& s = options.settings;
  logInfo("{} of merlind \"{}\" at {}:{}: {}, {}, {} clients at most", rfb::viewName(s.view),
          s.instance, s.listen.address, server->port(),
          s.password.empty() ? "no password" : "with a password",
          s.allow_input ? "clients move the model" : "clients only look", s.clients);
  warnOfCard(s);
  const auto ran = server->run(stop);
  return ran ? kExitDone : fail(ran.error());
}

manual::PageSettings page() {
  return {.name = "merlin-rfb",
          .summary = "shows the display wall MERLIN to VNC clients",
          .section = 1,
          .files = {{"/etc/merlin/rfb.conf",
                     "options for merlin-rfb.service: MERLIN_RFB_OPTIONS=\"...\""}},
          .see_also = {"merlin(1)", "merlind(8)"}};
}

int runProgram(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Shows MERLIN's wall to VNC clients (RFB). This program links libvncserver and is therefore "
      "distributed under the GPL, version 2 or later.\n\n"
      "Example: merlin-rfb --tile left --allow-input, then vncviewer 127.0.0.1:0");
  addOptions(app, options);
  app.set_version_flag("--version", programVersion());
  if (const auto status = parseArguments(app, argc, argv, page())) return *status;
  return serve(options);
}

}  // namespace
}  // namespace merlin

int main(int argc, char** argv) {
  merlin::openStandardStreams();
  return merlin::runGuarded("merlin-rfb", [&] { return merlin::runProgram(argc, argv); });
}
