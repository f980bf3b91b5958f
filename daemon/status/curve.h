// Keys of CURVE, ZeroMQ's encryption, which decides who may receive samples and send commands over
// a network.
#pragma once

#include <string>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/status/zap.h"

namespace merlin::status {

// A key pair; each key is 40 characters of Z85 (ZeroMQ RFC 32).
struct KeyPair {
  std::string public_key, secret_key;
};

// Makes a new key pair. Errors: kUnsupported (a libzmq without CURVE).
Result<KeyPair> makeKeyPair();

// Write and read a file of two lines, "public KEY" and "secret KEY". A written file can be read by
// its owner only. Errors, with the file's name: kNotFound, kIo, kMalformed.
Result<Ok> writeKeyPair(const std::string& path, const KeyPair& keys);
Result<KeyPair> readKeyPair(const std::string& path);

// Reads a file of public keys, one per line. Lines that begin with "# " are comments; text after a
// key is ignored. Errors: kNotFound, kIo, kMalformed, with the file's name and the line.
Result<std::vector<std::string>> readPublicKeys(const std::string& path);

// Whether the text is a valid key.
bool isKey(const std::string& text);

// Settings of an encrypted server for other machines.
struct CurveServer {
  std::string endpoint;  // "tcp://*:7401"; empty: none
  KeyPair keys;
  Door clients;  // public keys of the clients that may connect
};

}  // namespace merlin::status
