// The settings of merlin-rfb, which are options of its command line, and the password's file.
#pragma once

#include <string>

#include "daemon/base/result.h"
#include "daemon/rfb/view.h"

namespace merlin::rfb {

// The address at which VNC clients connect.
struct Listen {
  std::string address = "127.0.0.1";  // IPv4
  int port = 5900;                    // 0: any free port, which the log then names
};
// Parses "ADDRESS:PORT". Errors: kInvalidArgument.
Result<Listen> parseListen(const std::string& text);

struct RfbSettings {
  std::string instance = "merlin";  // name of the merlind instance whose wall is shown
  View view;
  Listen listen;
  std::string password;      // empty: none is asked for
  bool allow_input = false;  // whether pointer and keys of clients reach the wall
  int clients = 4;           // maximum number of connections
  int rate_hz = 20;          // pictures per second at most
};

// Checks the settings. Errors: kInvalidArgument (an address that other machines can reach, without
// a password).
Result<Ok> validate(const RfbSettings& settings);

// Reads the password, the first line of the file. Errors: kNotFound; kIo; kInvalidArgument (the
// file belongs to another user, or others have access to it; the password has 0 or more than 8
// characters, or characters outside printable ASCII).
Result<std::string> readPassword(const std::string& path);

}  // namespace merlin::rfb
