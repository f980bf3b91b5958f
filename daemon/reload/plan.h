// The table of the part of a running merlind to which each setting belongs, and the plan of what a
// reload does with a changed configuration.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "config/effective.h"

namespace merlin::reload {

// The parts that can be swapped while merlind runs; kRestart: the process has to start again.
enum class Part : std::size_t {
  kRestart,
  kBindings,    // bindings, and the time after which a failed device's inputs count as released
  kLine,        // line of a device, which is closed and opened again
  kHand,        // station and filter of hands; whose input moves the wall: persons, /people/turn_s
  kPostures,    // network, hold times, margin and drift
  kGestures,    // file of gestures, and for which hands they are recognised
  kRate,        // frame rate and limits of the triangles
  kPlaylist,    // what the wall shows while nobody uses it, and its light then
  kScene,       // how input moves what is shown; when the initial view returns
  kCorrection,  // corrections of outputs: warp, blend, colours and black level
  kCount
};

// Processes that read a setting, as a set of bits.
using Readers = std::uint32_t;
inline constexpr Readers kDevices = 1, kWall = 2, kPage = 4;
inline constexpr Readers kMirror = 8;  // a wall that uses another machine's devices
inline constexpr Readers kAlarms = 16;
inline constexpr Readers kAll = kDevices | kWall | kPage | kMirror | kAlarms;

struct Taker {
  std::string_view pointer;  // to a setting, a list or a group; "*" stands for any list index
  Readers readers;
  Part part;
};

// Returns the row of the table with the longest pointer that is `pointer` or a group around it. A
// pointer that no row covers, such as that of a new setting, needs a restart of every process, so
// that no change is ignored.
Taker takerOf(std::string_view pointer);

// Returns all rows of the table, for tests.
std::vector<Taker> takers();

struct Plan {
  std::vector<SettingChange> swapped;    // changes that this process can apply while it runs
  std::vector<SettingChange> restart;    // changes that it applies only at its start
  std::vector<SettingChange> elsewhere;  // changes to settings that only other processes read
  std::array<bool, static_cast<std::size_t>(Part::kCount)> parts{};  // of `swapped`
  std::vector<bool> lines;  // for kLine: whether each device has changes, by index; devices beyond
                            // the end have none

  bool has(Part part) const { return parts[static_cast<std::size_t>(part)]; }
};

// Sorts the changes by what a process must do about them. `process`: the readers that are part of
// the process.
Plan planFor(const std::vector<SettingChange>& changes, Readers process);

// Copies the settings of the parts in `plan` from `fresh` to `running`; all other settings stay.
// `keep_ports`: the devices' ports, which are those of emulators, stay too.
void adopt(const Plan& plan, const Settings& fresh, bool keep_ports, Settings& running);

}  // namespace merlin::reload
