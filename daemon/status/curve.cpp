#include "daemon/status/curve.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <sys/stat.h>
#include <zmq.hpp>

#include "daemon/base/files.h"

namespace merlin::status {
namespace {

constexpr std::size_t kKeyLength = 40;
constexpr std::string_view kAlphabet =
    "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.-:+=^!/*?&<>()[]{}@%$#";

Result<std::string> readAll(const std::string& path) {
  const auto file = FileCopy::read(path, 65536);
  if (!file) return file.error();
  return std::string(file->text());
}

}  // namespace

bool isKey(const std::string& text) {
  std::uint8_t key[kKeyLength / 5 * 4];
  return text.size() == kKeyLength && text.find_first_not_of(kAlphabet) == std::string::npos &&
         ::zmq_z85_decode(key, text.c_str()) != nullptr;
}

Result<KeyPair> makeKeyPair() {
  char public_key[kKeyLength + 1], secret_key[kKeyLength + 1];
  if (::zmq_curve_keypair(public_key, secret_key) != 0)
    return Error{Errc::kUnsupported, "this libzmq was built without CURVE"};
  return KeyPair{public_key, secret_key};
}

Result<Ok> writeKeyPair(const std::string& path, const KeyPair& keys) {
  const mode_t before = ::umask(0077);
  auto written =
      writeFile(path, fmt::format("public {}\nsecret {}\n", keys.public_key, keys.secret_key));
  ::umask(before);
  if (written) ::chmod(path.c_str(), 0600);
  return written;
}

Result<KeyPair> readKeyPair(const std::string& path) {
  const auto text = readAll(path);
  if (!text) return text.error();
  std::istringstream words(*text);
  KeyPair keys;
  for (std::string name, key; words >> name >> key;) {
    if (name == "public") keys.public_key = key;
    if (name == "secret") keys.secret_key = key;
  }
  if (isKey(keys.public_key) && isKey(keys.secret_key)) return keys;
  return Error{Errc::kMalformed,
               fmt::format("{}: has no key pair; make one with: merlin keys -o {}", path, path)};
}

Result<std::vector<std::string>> readPublicKeys(const std::string& path) {
  const auto text = readAll(path);
  if (!text) return text.error();
  std::istringstream lines(*text);
  std::vector<std::string> keys;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key.empty() || line.starts_with("# ")) continue;
    if (!isKey(key)) {
      return Error{
          Errc::kMalformed,
          fmt::format("{}: line {}: \"{}\" is not a valid public key (40 characters, as merlin "
                      "keys prints them)",
                      path, number, key)};
    }
    keys.push_back(key);
  }
  return keys;
}

}  // namespace merlin::status
