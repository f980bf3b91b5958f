#include "daemon/page/thumbnails.h"

#include <algorithm>
#include <utility>

#include "daemon/base/files.h"
#include "daemon/base/fixed_text.h"
#include "daemon/base/log.h"
#include "daemon/base/printable_text.h"
#include "daemon/page/scale_down.h"
#include "render/image/jpeg_writer.h"

namespace merlin::page {
namespace {

constexpr auto kTick = std::chrono::milliseconds(250);
constexpr Duration kAsked = std::chrono::seconds(10);  // for which a request counts as interest
constexpr Duration kReadAgain = std::chrono::minutes(1);
constexpr int kThumbnailQuality = 82;
constexpr std::size_t kLongestFault = 300;

std::string keyOf(const PageContent& content) { return content.name + '\0' + content.path; }

std::vector<PageContent> firstOf(std::vector<PageContent> contents) {
  if (contents.size() > Thumbnails::kMost) contents.resize(Thumbnails::kMost);
  return contents;
}

}  // namespace

Result<std::string> thumbnailOf(const render::image::Image& image) {
  // The greatest width for which the height stays within its limit, too.
  const auto width =
      std::clamp<std::int64_t>(std::int64_t{Thumbnails::kMostHeight} * image.width / image.height,
                               1, Thumbnails::kMostWidth);
  const render::image::Image small =
      scaleDown(image.pixels, image.width, image.height, static_cast<int>(width));
  return render::image::encodeJpeg(small.width, small.height, small.pixels, kThumbnailQuality);
}

Thumbnails::Thumbnails(const std::string& instance, std::vector<PageContent> contents,
                       ThumbnailFiles files, std::uint64_t first, ThreadWatch& watch, Clock& clock)
    : contents_(firstOf(std::move(contents))),
      files_(std::move(files)),
      clock_(clock),
      next_(first),
      wall_(shm::segmentName(instance, "wall"), SharedMemory::From::kOwnGroup),
      picture_(instance, {}, SharedMemory::From::kOwnGroup) {
  for (const PageContent& c : contents_) entries_.push_back({{c.name, c.kind, 0, ""}, {}, {}});
  thread_ = WatchedThread(watch, "thumbnails of the page",
                          [this](const std::stop_token& stop, Progress& p) { loop(stop, p); });
}

Thumbnails::~Thumbnails() { thread_.stop(); }

std::vector<ContentState> Thumbnails::contents() {
  const std::lock_guard lock(mutex_);
  asked_ = clock_.now();
  std::vector<ContentState> states;
  for (const Entry& entry : entries_) states.push_back(entry.state);
  return states;
}

std::shared_ptr<const std::string> Thumbnails::jpeg(std::uint64_t place) const {
  const std::lock_guard lock(mutex_);
  if (place < kMost) return place < entries_.size() ? entries_[place].jpeg : nullptr;
  return place - kMost < shown_.all().size() ? shown_.all()[place - kMost].jpeg : nullptr;
}

std::vector<ShownState> Thumbnails::shown() const {
  const std::lock_guard lock(mutex_);
  std::vector<ShownState> states;
  for (const ShownPictures::Picture& p : shown_.all())
    states.push_back({p.name, p.number, kMost + states.size()});
  return states;
}

void Thumbnails::loop(const std::stop_token& stop, Progress& progress) {
  giveWay();
  readFiles(progress);
  while (!stop.stop_requested()) {
    progress.step();
    const Timestamp now = clock_.now();
    followWall(now);
    readOne(now, progress);
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, stop, kTick, [] { return false; });
  }
}

// Reads the next content's file that is due: one that was never read or, while somebody looks at
// the contents, was last read a minute ago or earlier.
void Thumbnails::readOne(Timestamp now, Progress& progress) {
  bool looked_at = false;
  {
    const std::lock_guard lock(mutex_);
    looked_at = asked_ && now - *asked_ < kAsked;
  }
  for (std::size_t i = 0; i < contents_.size(); ++i) {
    std::optional<Timestamp>& read_at = entries_[i].read_at;
    if (read_at && (!looked_at || now - *read_at < kReadAgain)) continue;
    read_at = now;
    const Progress::Pause pause(progress);  // a disk may be slow
    if (!contents_[i].read) {
      note(i, fileStamp(contents_[i].path) ? "" : contents_[i].path + ": does not exist");
      continue;
    }
    const auto picture = contents_[i].read();
    auto jpeg = picture ? thumbnailOf(picture->image) : picture.error();
    if (!jpeg) return note(i, jpeg.error().what);
    keep(i, *std::move(jpeg));
    const std::lock_guard lock(mutex_);
    ContentState& state = entries_[i].state;
    if (picture->panorama && state.kind == "picture") state.kind = "panorama";
    return;
  }
}

// Returns what the wall shows now; nothing while no wall of this release runs.
std::optional<Showing> Thumbnails::showing(Timestamp now) {
  const shm::WallSegment* const wall = wall_.get(now);
  if (!wall) return std::nullopt;
  const auto content = wall->content.read();
  const auto interaction = wall->interaction.read();
  const auto idle = wall->idle.read();
  const auto stats = wall->stats.read();
  if (!content || !interaction || !idle || !stats) return std::nullopt;
  const bool covered = interaction->shown != shm::WallInteraction::kPicture ||
                       interaction->light < 1 || idle->testcard != 0;
  return Showing{std::string(textIn(content->name)), covered, stats->full_detail != 0};
}

// Takes the wall's picture as the thumbnail of the content that it shows, if that is a model or not
// in the configuration and watch_ finds the picture suitable.
void Thumbnails::followWall(Timestamp now) {
  const auto before = showing(now);
  if (!before || !watch_.update(*before, now)) return;
  const auto found = std::ranges::find_if(contents_, [&](const PageContent& c) {
    return c.name.substr(0, sizeof(shm::WallContent::name) - 1) == before->content;
  });
  if (found != contents_.end() && found->read) return;
  (void)picture_.update(now);
  const auto after = showing(now);
  // Drops the picture if another content came up, or something covered the content, while the frame
  // was copied.
  if (!picture_.card().empty() || !after || after->content != before->content || after->covered)
    return;
  render::image::Image image{picture_.width(), picture_.height(), {}};
  image.pixels.assign(picture_.pixels().begin(), picture_.pixels().end());
  if (found == contents_.end()) return keepShown(before->content, image);
  keepModel(static_cast<std::size_t>(found - contents_.begin()), image);
}

void Thumbnails::keepShown(const std::string& name, const render::image::Image& image) {
  auto jpeg = thumbnailOf(image);
  if (!jpeg) return logWarning("there is no thumbnail of {}: {}", name, jpeg.error().what);
  const std::lock_guard lock(mutex_);
  if (shown_.keep(name, *std::move(jpeg), next_)) ++next_;
}

void Thumbnails::keepModel(std::size_t place, const render::image::Image& image) {
  auto jpeg = thumbnailOf(image);
  if (!jpeg) return note(place, jpeg.error().what);
  const std::string bytes = *jpeg;
  if (!keep(place, *std::move(jpeg))) return;
  const auto written = files_.write(keyOf(contents_[place]), bytes);
  // Logged once and not for each picture of a playlist, because the folder is usually full or
  // read-only for a long time.
  if (!written && !unwritable_)
    logWarning("thumbnails are not kept over restarts: {}", written.error().what);
  unwritable_ = !written;
}

// Reads the pictures of models that earlier runs have kept.
void Thumbnails::readFiles(Progress& progress) {
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < contents_.size(); ++i) {
    keys.push_back(keyOf(contents_[i]));
    if (contents_[i].read) continue;
    if (auto jpeg = files_.read(keys.back())) keep(i, *std::move(jpeg));
    progress.step();
  }
  files_.removeOthers(keys);
}

// Keeps the picture as the thumbnail of the content at `place`; returns false if it is the same as
// before.
bool Thumbnails::keep(std::size_t place, std::string jpeg) {
  const std::lock_guard lock(mutex_);
  Entry& entry = entries_[place];
  entry.state.fault.clear();
  if (entry.jpeg && *entry.jpeg == jpeg) return false;
  entry.jpeg = std::make_shared<const std::string>(std::move(jpeg));
  entry.state.thumbnail = next_++;
  return true;
}

void Thumbnails::note(std::size_t place, const std::string& fault) {
  const std::lock_guard lock(mutex_);
  entries_[place].state.fault =
      oneLine(wholeCharacters(std::string_view(fault).substr(0, kLongestFault)));
}

}  // namespace merlin::page
