// A lab's day on virtual time: people who come and go, faults, reloads; and merlind's main thread,
// which writes heartbeats, repairs shared memory, and publishes events, status and alarms. Each
// simulated fault declares which events it explains.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/settings.h"
#include "daemon/alarms/alarm_queue.h"
#include "daemon/base/event_kinds.h"
#include "daemon/page/event_log.h"
#include "daemon/state/state_keeper.h"
#include "daemon/status/health_events.h"
#include "daemon/status/services.h"
#include "daemon/status/wall_events.h"
#include "daemon/wall/message_board.h"
#include "tests/bench/soak/virtual_devices.h"
#include "tests/bench/soak/virtual_wall.h"

namespace merlin::bench {

// What each person does at present, as the number of a phase of the emulators' motion script.
struct Persons {
  std::size_t first = 0, guest = 0;
};

// Returns the motion script of a person. `held`: the member of Persons that has the person's phase.
const emulate::MotionScript& scriptOf(const std::size_t& held);

// The storage of the state file, whose disk can be full.
class VirtualDisk final : public state::StateFiles {
 public:
  bool full = false;

  Result<std::string> read() override;
  Result<std::string> readPrevious() override { return read(); }
  Result<Ok> write(const std::string& text) override;
  Result<Ok> putAside() override { return Ok{}; }
  const std::string& name() const override { return name_; }

 private:
  std::string text_, name_ = "the state";
};

// Counts of a day.
struct DayCounts {
  std::uint64_t visits = 0, faults = 0, reloads = 0, alarms = 0, documents = 0;
  std::map<std::string, std::map<std::string, std::uint64_t>>
      events;                      // number of events by their kind, then by what explains them
  std::vector<std::string> wrong;  // unexplained or missing events, wrong answers to reloads
  std::uint64_t digest = 0xcbf29ce484222325;  // hash of all events and their times
};

// Thread-bound.
class VirtualDay {
 public:
  struct Parts {
    nlohmann::json configuration;  // configuration from which the settings were read
    std::string folder;            // folder to which the configuration's paths are relative
    Settings& settings;            // settings in effect; reloads change them
    Fibers& fibers;
    VirtualClock& clock;
    VirtualDevices& devices;
    VirtualWall& wall;
    Persons& persons;
  };
  VirtualDay(const Parts& parts, std::uint64_t seed);

  // Starts the fibers of people, faults and merlind's main thread. All faults end before `end`.
  void start(const std::stop_token& stop, Timestamp end);

  const DayCounts& counts() const { return counts_; }
  // Returns whether the renderer is slow on purpose now, or was a moment ago.
  bool isSlow() const { return parts_.clock.now() < slow_until_; }
  // Returns the events that were expected and did not come; to be called at the end of the day.
  std::vector<std::string> untold() const;

 private:
  struct Explanation {
    std::string fault, kind, pattern;
    std::regex expression;
    Timestamp until;
    bool due;
    std::uint64_t count = 0;
  };
  using Fault = void (VirtualDay::*)();

  double between(double low, double high);
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(random_() % count); }
  bool sleep(double seconds);
  void explain(const std::string& fault, const std::string& kind, const std::string& pattern,
               bool due = false, double seconds = 60);
  void explainDevice(const std::string& fault, std::size_t device);

  void people(const std::stop_token& stop);
  void visit();
  void command();
  void faults(const std::stop_token& stop, Timestamp end);
  void unplugDevice();
  void switchDeviceOff();
  void disturbLine();
  void removeSharedMemory();
  void fillDisk();
  void slowRenderer();
  void unplugOutput();
  void blackenOutput();
  void reloadWell();
  void reloadBadly();
  bool reload(const nlohmann::json& patch);

  void mainThread(const std::stop_token& stop);
  void takeEvents(Timestamp now);
  void add(const char* role, const EventKind& kind, const std::vector<Event>& events);
  void judge(const page::LoggedEvent& event);
  void tend(Timestamp now);

  Parts parts_;
  std::mt19937_64 random_, people_random_;
  std::stop_token stop_;
  Timestamp begin_, slow_until_{};
  Settings configured_;
  std::size_t variant_ = 0;
  std::vector<Explanation> explanations_;
  ThreadWatch watch_;
  VirtualDisk* disk_;  // owned by keeper_
  state::StateKeeper keeper_;
  status::Services services_;
  status::HealthEvents health_events_;
  status::WallEvents wall_events_;
  page::EventLog log_{1};
  std::uint64_t told_ = 0;
  wall::MessageBoard board_;
  alarms::AlarmQueue alarm_;
  DayCounts counts_;
};

}  // namespace merlin::bench
