#include "daemon/page/picture_maker.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <sys/eventfd.h>
#include <unistd.h>

#include "daemon/page/scale_down.h"
#include "render/image/jpeg_writer.h"

namespace merlin::page {
namespace {

constexpr Duration kInterest = std::chrono::seconds(3);
constexpr auto kIdle = std::chrono::milliseconds(500);
constexpr int kQuality = 80;

bool sameView(const rfb::View& a, const rfb::View& b) {
  return a.kind == b.kind && a.tile == b.tile;
}

}  // namespace

PictureMaker::PictureMaker(std::string instance, double rate_hz, std::uint64_t first,
                           ThreadWatch& watch, Clock& clock)
    : instance_(std::move(instance)),
      period_(fromSeconds(1 / rate_hz)),
      clock_(clock),
      event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      next_(first),
      thread_(watch, "pictures of the page",
              [this](const std::stop_token& stop, Progress& p) { loop(stop, p); }) {}

PictureMaker::~PictureMaker() { thread_.stop(); }

void PictureMaker::clear() const noexcept {
  std::uint64_t count = 0;
  (void)!::read(event_.get(), &count, sizeof count);
}

std::uint64_t PictureMaker::made() const {
  const std::lock_guard lock(mutex_);
  return made_;
}

std::optional<MadePicture> PictureMaker::newest(const PictureKind& kind) {
  const Timestamp now = clock_.now();
  const std::lock_guard lock(mutex_);
  std::erase_if(kinds_, [&](const Kind& k) { return now - k.wanted > kInterest; });
  auto found = std::ranges::find(kinds_, kind, &Kind::kind);
  if (found == kinds_.end()) {
    if (kinds_.size() >= kMostKinds) return std::nullopt;
    kinds_.push_back({kind, now, {}});
    found = kinds_.end() - 1;
    wake_.notify_one();
  }
  found->wanted = now;
  return found->made;
}

std::vector<PictureKind> PictureMaker::wantedKinds(Timestamp now) {
  const std::lock_guard lock(mutex_);
  std::vector<PictureKind> wanted;
  for (const Kind& k : kinds_) {
    if (now - k.wanted <= kInterest) wanted.push_back(k.kind);
  }
  return wanted;
}

void PictureMaker::loop(const std::stop_token& stop, Progress& progress) {
  giveWay();
  while (!stop.stop_requested()) {
    progress.step();
    const Timestamp now = clock_.now();
    const std::vector<PictureKind> wanted = wantedKinds(now);
    dropUnwanted(wanted);
    if (wanted.empty()) {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, stop, kIdle, [&] { return !kinds_.empty(); });
      if (!kinds_.empty() && clock_.now() - kinds_.front().wanted > kInterest) kinds_.clear();
      continue;
    }
    makeAll(wanted, now, progress);
    clock_.sleepUntil(now + period_, stop);
  }
}

// Deletes the views that nobody looks at any more, because each holds a copy of the frame.
void PictureMaker::dropUnwanted(const std::vector<PictureKind>& kinds) {
  std::erase_if(views_, [&](const View& v) {
    return std::ranges::none_of(kinds,
                                [&](const PictureKind& k) { return sameView(k.view, v.view); });
  });
}

void PictureMaker::makeAll(const std::vector<PictureKind>& kinds, Timestamp now,
                           Progress& progress) {
  for (const PictureKind& kind : kinds) viewOf(kind.view);
  for (View& view : views_) {
    const auto change = view.shown->update(now);
    view.changes += change.resized || !change.changed.empty();
    progress.step();
  }
  for (const PictureKind& kind : kinds) {
    make(kind, viewOf(kind.view));
    progress.step();
  }
}

PictureMaker::View& PictureMaker::viewOf(const rfb::View& view) {
  const auto found =
      std::ranges::find_if(views_, [&](const View& v) { return sameView(v.view, view); });
  if (found != views_.end()) return *found;
  views_.push_back(
      {view, std::make_unique<rfb::ShownPicture>(instance_, view, SharedMemory::From::kOwnGroup),
       1});
  return views_.back();
}

// Whether no new picture of this kind is needed: the last one was made after this number of changes
// of the view, or nobody wants the kind any more.
bool PictureMaker::isShownBy(const PictureKind& kind, std::uint64_t changes) const {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(kinds_, kind, &Kind::kind);
  return found == kinds_.end() || found->changes == changes;
}

void PictureMaker::make(const PictureKind& kind, const View& view) {
  if (isShownBy(kind, view.changes)) return;
  const render::image::Image image =
      scaleDown(view.shown->pixels(), view.shown->width(), view.shown->height(), kind.width);
  auto jpeg = render::image::encodeJpeg(image.width, image.height, image.pixels, kQuality);
  if (!jpeg) return;  // no memory; the next picture may succeed
  auto bytes = std::make_shared<const std::string>(*std::move(jpeg));
  {
    const std::lock_guard lock(mutex_);
    ++made_;
    const auto found = std::ranges::find(kinds_, kind, &Kind::kind);
    if (found == kinds_.end()) return;
    found->made = {next_++, std::move(bytes), view.shown->width(), view.shown->height(),
                   view.shown->panel()};
    found->changes = view.changes;
  }
  const std::uint64_t one = 1;
  (void)!::write(event_.get(), &one, sizeof one);
}

}  // namespace merlin::page
