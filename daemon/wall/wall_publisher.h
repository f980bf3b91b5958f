// WallPublisher: writes the wall's statistics to its shared-memory segment.
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

// Slots of the segment; a null slot is not written.
struct WallSlots {
  shm::SeqSlot<shm::WallStats>& stats;
  shm::Channel<shm::FrameTrace>* trace = nullptr;
  shm::SeqSlot<shm::WallInteraction>* interaction = nullptr;
  shm::SeqSlot<shm::WallOutputs>* outputs = nullptr;
  shm::SeqSlot<shm::WallContent>* content = nullptr;
  shm::SeqSlot<shm::WallIdle>* idle = nullptr;
};

// Thread-bound to the wall's thread: it is the only writer of these slots.
class WallPublisher {
 public:
  explicit WallPublisher(const WallSlots& slots) : slots_(slots) {}

  void trace(const FrameTracer& tracer);

  // Publishes `counted`, in which the loop has set the fields that it counts itself; stats() sets
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

  // `out`: has the fields that the loop sets itself; those of pointing are set from the other
  // arguments.
  void interaction(shm::WallInteraction out, const render::scene::SceneView& view,
                   const render::frame::PointerMarker* marker, Timestamp now);
  void outputs(const render::out::OutputSet& outputs, Timestamp now);
  // `result`: what became of the last request for a content. All other fields are set from `shown`.
  void content(const ShownContent& shown, const ShowResult& result, Timestamp now);
  // `testcard`: whether a test card covers the picture.
  void idle(const Playlist::Due& due, bool testcard, Timestamp now);

 private:
  WallSlots slots_;
};

}  // namespace merlin::wall
