// Transcripts: the bytes that a device and its host exchanged, as a text file that people can read,
// write and compare; recorded, dumped by the flight recorder or written by hand.
//
//   # device: Spaceball 2003, firmware unknown      # synthetic: yes (merlin emulate, seed 7)
//   # serial: 9600 8N1 xonxoff                      # driver: spaceball
//   @0.300000 to 0d405245534554 0d                  <- host to device; comments start like this
//   @0.350000 4400100001ffff0100000000000000 0d     <- device to host
//   4400100001ffff0100000000000000 0d               <- no time: directly after the last chunk
//   # end
//
// Bytes are hexadecimal, times are seconds since the start. The line "# end" shows that the file is
// complete.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"

namespace merlin::io {

struct TranscriptChunk {
  Duration at{};           // time since the start; not before the previous chunk
  bool to_device = false;  // written by the host
  std::string bytes;
};

struct Transcript {
  std::vector<std::pair<std::string, std::string>> header;  // key and value, in the file's order
  std::vector<TranscriptChunk> chunks;

  // Returns the value of a key of the header; empty if the header has no such key.
  std::string_view operator[](std::string_view key) const;
  int baud() const;  // from the key "serial"; 9600 if it has no number
};

// Parse and format the text of a transcript. Errors: kMalformed if a chunk is not hexadecimal or
// ends in half a byte, a time is before that of the previous chunk, or "# end" is missing; the
// message names the line.
Result<Transcript> parseTranscript(std::string_view text);
std::string formatTranscript(const Transcript& transcript);

// Reads a transcript from a file. Errors: kNotFound, kIo, and those of parseTranscript(), with the
// file's name in the message.
Result<Transcript> readTranscript(const std::string& path);

}  // namespace merlin::io
