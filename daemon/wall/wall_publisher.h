// WallPublisher: writes the wall's statistics to the wall's shared-memory segment.
#pragma once

#include <optional>
#include <string_view>

#include "daemon/base/clock.h"
#include "daemon/shm/layout.h"
#include "daemon/wall/content_turns.h"
#include "daemon/wall/frame_stats.h"
#include "daemon/wall/frame_tracer.h"
#include "daemon/wall/pace.h"
#include "daemon/wall/playlist.h"
#include "daemon/wall/show_results.h"
#include "render/frame/pointer_marker.h"
#include "render/governor/governor.h"
#include "render/out/output_set.h"
#include "render/scene/scene.h"

namespace merlin::wall {

// Slots of the wall's segment. A null slot is not written.
struct WallSlots {
  shm::SeqSlot<shm::WallStats>& stats;
  shm::Channel<shm::FrameTrace>* trace = nullptr;
  shm::SeqSlot<shm::WallInteraction>* interaction = nullptr;
  shm::SeqSlot<shm::WallOutputs>* outputs = nullptr;
  shm::SeqSlot<shm::WallContent>* content = nullptr;
  shm::SeqSlot<shm::WallIdle>* idle = nullptr;
};

// Thread-bound to the wall's thread, which is the only writer of these slots.
class WallPublisher {
 public:
  explicit WallPublisher(const WallSlots& slots) : slots_(slots) {}

  void trace(const FrameTracer& tracer);

  // Publishes `counted`, in which the loop has set the fields that it counts itself, after setting
  // all other fields from `state`.
  struct State {
    const ContentTurns& turns;
    const Pace& pace;
    const render::governor::Governor& governor;
    const FrameStats& frames;
    const render::scene::SceneView& view;
    std::size_t step;
  };
  void stats(shm::WallStats counted, const State& state, Timestamp now);

  // Publishes `out`, in which the loop has set some fields, after setting the time and the fields
  // about pointing from the other arguments. `marker`: computes the pixel that is pointed at; may
  // be null.
  void interaction(shm::WallInteraction out, const render::scene::SceneView& view,
                   const render::frame::PointerMarker* marker, Timestamp now);
  void outputs(const render::out::OutputSet& outputs, Timestamp now);
  // Publishes the content `shown` and `result`, the result of a request for a content.
  void content(const ShownContent& shown, const ShowResult& result, Timestamp now);
  // Publishes what the wall will do by itself. `testcard`: whether a test card covers the picture.
  void idle(const Playlist::Due& due, bool testcard, Timestamp now);

 private:
  WallSlots slots_;
};

}  // namespace merlin::wall
