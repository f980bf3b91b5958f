// Keys of CURVE, ZeroMQ's encryption: who may listen to a daemon over a network.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/result.h"

namespace merlin::status {

// Each 40 characters of Z85.
struct KeyPair {
  std::string public_key, secret_key;
};

// Errors: kUnsupported (a libzmq without CURVE).
Result<KeyPair> makeKeyPair();

// A file of two lines, "public KEY" and "secret KEY", that nobody but its owner may read.
// Errors: kNotFound, kIo, kMalformed, naming the file.
Result<Ok> writeKeyPair(const std::string& path, const KeyPair& keys);
Result<KeyPair> readKeyPair(const std::string& path);

// Public keys, one a line; what follows a '#' is a comment. Errors: as above, naming the line.
Result<std::vector<std::string>> readPublicKeys(const std::string& path);

bool isKey(const std::string& text);

// What a server of samples needs.
struct CurveServer {
  std::string endpoint;  // "tcp://*:7401"; empty: none
  KeyPair keys;
  std::vector<std::string> clients;  // public keys of those who may listen
};

}  // namespace merlin::status
