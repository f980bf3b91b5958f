// Sources: keeps the contacts that are now on the surfaces of trackers with TUIO 1.1, as reported
// in the messages of their datagrams. Pure.
//
// Each datagram is one or more frames of a profile: "source" (optional), "alive" with the session
// numbers of all contacts, a "set" for each contact that moved, "fseq" with the frame's number. Of
// the profiles, /tuio/2Dcur (fingers) and /tuio/2Dobj (marked objects) are read; an object counts
// as a finger, and its angle is left out.
//
// Source: M. Kaltenbrunner et al., TUIO 1.1 Protocol Specification, tuio.org.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "daemon/base/clock.h"
#include "drivers/port/osc_packet.h"
#include "drivers/port/touch_frames.h"

namespace merlin::tuio {

class Sources final : public OscSink {
 public:
  static constexpr std::size_t kMostSources = 4;
  static constexpr std::size_t kMostContacts = 64;  // per profile and source
  // A source that sends nothing for this long is taken to have no contacts any more.
  static constexpr Duration kSilent = std::chrono::seconds(2);
  // Ids of objects begin here, ids of fingers at 1.
  static constexpr std::uint32_t kFirstObject = 0x80000000;

  // Begins a datagram of this sender; take() must then be called for each of its messages.
  void begin(std::uint32_t sender, Timestamp now) noexcept;
  // Ignores a message that does not belong to TUIO or to the two profiles. A malformed message is
  // dropped and counted, and the rest of its frame is dropped as well.
  void take(const OscMessage& message) noexcept override;
  // Returns whether the datagram has completed a frame.
  bool complete() const noexcept { return complete_; }

  // Removes the sources that are silent; returns whether there was one.
  bool forgetSilent(Timestamp now) noexcept;
  void clear() noexcept;  // removes all sources

  // Adds all contacts to a frame that has begun, in the order of sources, fingers first.
  void fill(TouchFrames& frames) const noexcept;

  std::size_t number() const noexcept;  // number of sources
  std::uint64_t badMessages() const noexcept { return bad_messages_; }
  std::uint64_t lateFrames() const noexcept { return late_frames_; }  // arrived after a later frame
  // Returns why the newest dropped message was dropped; empty if no message was dropped since the
  // last complete frame.
  const char* fault() const noexcept { return fault_; }

 private:
  struct Contact {
    std::int32_t session = 0;
    std::uint32_t id = 0;
    float x = 0, y = 0;
  };
  struct Contacts {
    std::array<Contact, kMostContacts> list{};
    std::size_t count = 0;
    const Contact* find(std::int32_t session) const noexcept;
  };
  struct Profile {
    Contacts now;
    std::int32_t frame = -1;  // number of the newest frame; -1: none so far
  };
  enum ProfileIndex : std::size_t { kFingerProfile, kObjectProfile, kProfiles };
  struct Source {
    bool used = false;
    std::uint32_t key = 0;
    Timestamp heard{};
    std::array<Profile, kProfiles> profiles{};
  };
  // A frame that is not complete yet.
  struct Pending {
    std::array<std::int32_t, kMostContacts> alive{};
    std::size_t alive_count = 0;
    Contacts set;
    bool has_alive = false, bad = false;
  };

  void drop(Pending& frame, const char* why) noexcept;
  void takeAlive(std::span<const OscArgument> sessions, Pending& frame) noexcept;
  void takeSet(std::span<const OscArgument> values, ProfileIndex profile, Pending& frame) noexcept;
  void takeFrame(std::span<const OscArgument> values, ProfileIndex profile,
                 Pending& frame) noexcept;
  void commit(ProfileIndex profile, const Pending& frame, Profile& into) noexcept;
  Source* current() noexcept;

  std::array<Source, kMostSources> sources_{};
  std::array<Pending, kProfiles> pending_{};
  std::uint32_t key_ = 0;  // source of the present datagram
  Timestamp now_{};
  bool complete_ = false;
  std::array<std::uint32_t, kProfiles> next_id_{1, kFirstObject};
  std::uint64_t bad_messages_ = 0, late_frames_ = 0;
  const char* fault_ = "";
};

}  // namespace merlin::tuio
