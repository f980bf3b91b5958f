// Outputs of kind kms: the displays of graphics cards, driven without a desktop.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "daemon/base/kept_files.h"
#include "daemon/base/watched_thread.h"
#include "render/out/kms/displays.h"
#include "render/out/kms/settings.h"
#include "render/out/output.h"

namespace merlin::render::out::kms {

// A card, with the thread that commits frames to its displays and looks for new ones.
class CardWorker {
 public:
  // `kept_files`, `watch` and `clock` outlive this.
  CardWorker(std::string path, KeptFiles& kept_files, ThreadWatch& watch, const Clock& clock);
  ~CardWorker();
  CardWorker(const CardWorker&) = delete;
  CardWorker& operator=(const CardWorker&) = delete;

  Displays& displays() { return displays_; }
  // Starts the thread; later calls do nothing. REQUIRES: all outputs have been added.
  void start();

 private:
  std::string path_;
  ThreadWatch& watch_;
  Displays displays_;
  bool started_ = false;
  WatchedThread thread_;
};

// The cards of a wall; the outputs on one card share it. Thread-bound.
class Cards {
 public:
  Cards(KeptFiles& kept_files, ThreadWatch& watch, const Clock& clock)
      : kept_files_(kept_files), watch_(watch), clock_(clock) {}

  // Starts each card's thread, which opens the card, and waits at most 2 s for its first look at
  // the displays. To be called after all outputs were made, and before other code of this process,
  // such as Mesa, opens a card: whoever opens a card that has no DRM master becomes it, and only
  // the thread that opened it, or root, can give that up.
  void open();

  // Makes an output on the card that `settings` names; its picture has this size [px]. Never fails,
  // since a missing card or display may appear later; until then Output::faultNow() says what is
  // missing.
  std::unique_ptr<Output> makeOutput(const KmsSettings& settings, int picture_width,
                                     int picture_height);

 private:
  KeptFiles& kept_files_;
  ThreadWatch& watch_;
  const Clock& clock_;
  // Each is shared by the outputs of its card; the last of them that is destroyed releases the
  // card.
  std::map<std::string, std::weak_ptr<CardWorker>> workers_;  // by path
};

}  // namespace merlin::render::out::kms
