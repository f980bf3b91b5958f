#include "drivers/io/transcript.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"

namespace merlin::io {
namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr std::size_t kLongestFile = std::size_t{256} << 20;
constexpr double kLongestTime_s = 1e7;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

std::string_view takeWord(std::string_view& text) {
  text = trimmed(text);
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(word.size());
  return word;
}

int nibble(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

class Reader {
 public:
  Result<Transcript> read(std::string_view text) {
    for (; !text.empty(); ++line_) {
      const std::string_view whole = text.substr(0, text.find('\n'));
      text.remove_prefix(std::min(whole.size() + 1, text.size()));
      const std::string_view line = trimmed(whole.substr(0, whole.find("<-")));
      if (line.empty()) continue;
      if (ended_) return errorInLine("comes after \"# end\"");
      if (line.starts_with('#')) {
        readHeader(line);
      } else if (const auto done = readChunk(line); !done) {
        return done.error();
      }
    }
    if (!ended_) {
      return Error{Errc::kMalformed,
                   fmt::format("ends after line {} without \"# end\": it was cut off", line_ - 1)};
    }
    return std::move(transcript_);
  }

 private:
  Error errorInLine(std::string_view what) const {
    return {Errc::kMalformed, fmt::format("line {} {}", line_, what)};
  }

  // Reads a line with one or more entries "# key: value".
  void readHeader(std::string_view line) {
    while (!line.empty()) {
      line.remove_prefix(1);  // '#'
      const std::string_view part = trimmed(line.substr(0, line.find("# ")));
      line.remove_prefix(std::min(line.find("# "), line.size()));
      const std::size_t colon = part.find(": ");
      if (colon != std::string_view::npos)
        transcript_.header.emplace_back(part.substr(0, colon), trimmed(part.substr(colon + 2)));
      ended_ |= part == "end";
    }
  }

  Result<Ok> readChunk(std::string_view line) {
    TranscriptChunk chunk;
    chunk.at = free_at_;
    if (line.starts_with('@')) {
      line.remove_prefix(1);
      const auto at = readTime(takeWord(line));
      if (!at) return errorInLine("has no valid time, in seconds, after its @");
      if (!transcript_.chunks.empty() && *at < transcript_.chunks.back().at)
        return errorInLine("has a time before that of the line above");
      chunk.at = *at;
    }
    line = trimmed(line);
    if (line.starts_with("to ")) {
      chunk.to_device = true;
      line.remove_prefix(3);
    }
    if (const auto hex = readHex(line, chunk.bytes); !hex) return hex;
    const auto bits = 10 * static_cast<std::int64_t>(chunk.bytes.size());
    free_at_ = chunk.at + std::chrono::nanoseconds(bits * 1'000'000'000 / baud());
    transcript_.chunks.push_back(std::move(chunk));
    return Ok{};
  }

  static std::optional<Duration> readTime(std::string_view word) {
    double seconds = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), seconds);
    if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    if (!(seconds >= 0 && seconds <= kLongestTime_s)) return std::nullopt;
    return fromSeconds(seconds);
  }

  Result<Ok> readHex(std::string_view text, std::string& bytes) const {
    int high = -1;
    for (const char c : text) {
      if (kBlanks.find(c) != std::string_view::npos) continue;
      const int value = nibble(c);
      if (value < 0) return errorInLine(fmt::format("has \"{}\" where hex digits are expected", c));
      if (high >= 0) bytes.push_back(static_cast<char>(high << 4 | value));
      high = high >= 0 ? -1 : value;
    }
    if (high >= 0) return errorInLine("ends in the middle of a byte");
    return Ok{};
  }

  // Returns the baud rate of the header, which is complete when the first chunk is read. The rate
  // is cached.
  int baud() {
    if (baud_ == 0) baud_ = transcript_.baud();
    return baud_;
  }

  Transcript transcript_;
  int line_ = 1;
  int baud_ = 0;
  bool ended_ = false;
  Duration free_at_{};
};

}  // namespace

std::string_view Transcript::operator[](std::string_view key) const {
  for (const auto& [k, value] : header) {
    if (k == key) return value;
  }
  return {};
}

int Transcript::baud() const {
  const std::string_view serial = (*this)["serial"];
  int baud = 0;
  std::from_chars(serial.data(), serial.data() + serial.size(), baud);
  return baud > 0 ? baud : 9600;
}

Result<Transcript> parseTranscript(std::string_view text) { return Reader().read(text); }

std::string formatTranscript(const Transcript& transcript) {
  std::string text;
  // oneLine(), because a device's identity may contain line breaks.
  for (const auto& [key, value] : transcript.header)
    text += fmt::format("# {}: {}\n", oneLine(key), oneLine(value));
  for (const TranscriptChunk& chunk : transcript.chunks) {
    text += fmt::format("@{:.6f} {}", toSeconds(chunk.at), chunk.to_device ? "to " : "");
    for (const char c : chunk.bytes) text += fmt::format("{:02x}", static_cast<std::uint8_t>(c));
    text += '\n';
  }
  return text + "# end\n";
}

Result<Transcript> readTranscript(const std::string& path) {
  const auto file = FileCopy::read(path, kLongestFile + 1);
  if (!file) return file.error();
  if (file->text().size() > kLongestFile)
    return Error{Errc::kMalformed, fmt::format("{}: is too long for a transcript", path)};
  auto transcript = parseTranscript(file->text());
  if (!transcript) {
    return Error{transcript.error().code, fmt::format("{}: {}; it is not a complete transcript",
                                                      path, transcript.error().what)};
  }
  return transcript;
}

}  // namespace merlin::io
