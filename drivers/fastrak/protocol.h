// Polhemus Fastrak wire format: converts bytes to records and back. No I/O, no clock.
//
// A data record with the output list 2,11,0 in binary has 32 bytes and no length or terminator:
//   '0'  station '1'..'4'  error ' ' or letter  x y z  q0 q1 q2 q3: 7 x f32le  ' '
// Other forms (Layout): azimuth, elevation and roll instead of the quaternion; decimal text; 14-bit
// numbers, two bytes of seven bits each (the first such byte of a record has bit 7 set); a stylus
// switch, ' ' and '0' or '1'. A reply is '2', the station, the command's letter, its data, CR LF.
//
// Sources: README.md beside this file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drivers/port/samples.h"

namespace merlin::fastrak {

inline constexpr std::size_t kRecordLength = 32;
inline constexpr std::size_t kStatusLength = 55;
inline constexpr std::size_t kStationsLength = 9;

struct Record {
  int station = 1;                                    // 1..4
  char error = ' ';                                   // ' ' or a letter of the built-in test
  std::array<float, 3> position{};                    // [inches], or [cm] after the command `u`
  std::array<float, 4> orientation_wxyz{1, 0, 0, 0};  // as received: norm 0.98..1.02
  bool stylus = false;                                // the stylus's button is pressed
  std::int64_t received_ns = 0;                       // arrival of the record's first byte
};

// Contents and format of a record.
struct Layout {
  enum class Numbers { kBinary, kText, kShort };
  Numbers numbers = Numbers::kBinary;
  bool angles = false;                  // azimuth, elevation, roll instead of the quaternion
  bool stylus = false;                  // the record includes item 16, the stylus switch
  bool centimetres = true;              // positions in cm, otherwise in inches
  float furthest = 500;                 // largest valid coordinate [cm or inches]
  std::size_t length() const noexcept;  // length of a record [bytes]
  std::string items() const;            // text of the output list: "2,11,0"
};

// The parser slides a window over the stream. Its content is a record if the fixed bytes are right,
// the coordinates are within the layout's `furthest`, angles within 180 degrees, and the norm of
// the quaternion is 0.98 to 1.02; out of synchronisation, the '0' of the next record must follow as
// well. Otherwise one byte is dropped and the content is checked again.
class Parser {
 public:
  // Empties the window and keeps the counters. The next byte is expected to be the first of a
  // record.
  void reset() noexcept;
  void expect(const Layout& layout) noexcept;  // sets the layout, then calls reset()

  // Takes one byte, which arrived at `received_ns`; returns a record when `byte` completes one.
  // Never blocks, never allocates. The parser stores the time of each byte, because a record's
  // first byte may be found among bytes that arrived earlier.
  std::optional<Record> feed(std::byte byte, std::int64_t received_ns) noexcept;

  // badPackets(): how often synchronisation was lost since construction. badBytes(): number of
  // bytes that were dropped to regain it.
  std::uint64_t badPackets() const noexcept { return bad_packets_; }
  std::uint64_t badBytes() const noexcept { return bad_bytes_; }

 private:
  static constexpr std::size_t kLongest = 56;

  bool plausible() const noexcept;
  bool readNumbers(Record& record) const noexcept;  // false if one is not plausible
  void drop() noexcept;
  Record take() noexcept;
  void shift(std::size_t count) noexcept;

  Layout layout_;
  std::size_t record_length_ = kRecordLength;
  std::array<std::uint8_t, kLongest + 1> window_{};
  std::array<std::int64_t, kLongest + 1> received_ns_{};  // arrival of each byte in the window
  std::size_t length_ = 0;
  bool locked_ = true;  // in synchronisation: the window starts where a record ended
  std::uint64_t bad_packets_ = 0;
  std::uint64_t bad_bytes_ = 0;
};

// The unit's answer to the command `S`.
struct Status {
  bool binary = false;
  bool centimetres = false;
  bool compensation = false;
  bool continuous = false;
  int test_error = 0;             // error of the built-in test; 0: none
  std::string firmware = "3.00";  // at most 6 characters
  std::string configuration;      // at most 32 characters
};
// Parses a status record, 55 bytes with its CR LF; nothing if `reply` is not one.
std::optional<Status> parseStatus(std::string_view reply);

// The unit's answer to the command `l`: element i tells whether station i + 1 is active.
// parseStations() returns nothing if `reply` is not such an answer, 9 bytes with its CR LF.
using Stations = std::array<bool, kStations>;
std::optional<Stations> parseStations(std::string_view reply) noexcept;

// Returns whether `item` may occur in an output list: 0 blank, 1 CR LF, 2 position, 4 azimuth,
// elevation and roll, 5 to 7 direction cosines of the axes, 11 quaternion, 16 stylus switch; 18, 19
// and 20: 2, 4 and 11 as 14-bit numbers.
bool isItem(int item) noexcept;

inline constexpr std::array<int, 3> kDefaultList = {2, 4, 1};  // default of the unit
inline constexpr std::array<int, 3> kDriverList = {2, 11, 0};

struct Form {
  bool binary = true;
  // Whether positions are in centimetres instead of inches; item 18 is scaled accordingly.
  bool centimetres = true;
};

// Return the bytes of a record and of replies; inverse of the parser, for the emulator. They
// support more forms than the driver requests. REQUIRES: isItem() is true for each item.
std::string encode(const Record& record, std::span<const int> items, const Form& form);
std::string encode(const Status& status);
std::string encode(const Stations& stations, int asked_station);

// Convert an orientation to azimuth, elevation and roll [degrees], R = Rz(az) Ry(el) Rx(roll), and
// back. REQUIRES: the quaternion is a unit quaternion.
std::array<float, 3> anglesOf(const std::array<float, 4>& orientation_wxyz) noexcept;
std::array<float, 4> quaternionOf(const std::array<float, 3>& angles_deg) noexcept;

// Returns the meaning of a letter of the built-in test; "" if the letter is not listed. Source:
// MAN12, p. 76.
std::string_view meaningOf(char error) noexcept;

}  // namespace merlin::fastrak
