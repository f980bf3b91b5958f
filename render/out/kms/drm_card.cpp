#include "render/out/kms/drm_card.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include <drm_fourcc.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include "daemon/base/unique_fd.h"
#include "render/out/kms/drm_buffer.h"
#include "render/out/kms/drm_objects.h"
#include "render/out/kms/drm_properties.h"
#include "render/out/kms/drm_saved_state.h"
#include "render/out/kms/drm_scanout.h"
#include "render/out/kms/drm_users.h"

namespace merlin::render::out::kms {
namespace {

namespace fs = std::filesystem;

Owned<drmModeConnector> connectorOf(int fd, Id id, bool probe) {
  return {probe ? drmModeGetConnector(fd, id) : drmModeGetConnectorCurrent(fd, id),
          drmModeFreeConnector};
}
Owned<drmModePlane> planeOf(int fd, Id id) { return {drmModeGetPlane(fd, id), drmModeFreePlane}; }

Mode modeOf(const drmModeModeInfo& info, int index) {
  // The rate in `vrefresh` is rounded: 59.94 Hz is not 60 Hz.
  const double total = static_cast<double>(info.htotal) * info.vtotal;
  double rate = total > 0 ? 1000.0 * info.clock / total : info.vrefresh;
  const bool interlaced = (info.flags & DRM_MODE_FLAG_INTERLACE) != 0;
  if (interlaced) rate *= 2;
  return {info.hdisplay, info.vdisplay, rate, (info.type & DRM_MODE_TYPE_PREFERRED) != 0,
          interlaced,    index};
}

// Returns the name by which systemd keeps the card's file: it has no colon, which systemd does not
// allow and which paths in /dev/dri/by-path contain.
std::string keptName(const std::string& path) {
  struct stat file {};
  if (::stat(path.c_str(), &file) != 0) return "card";
  return fmt::format("card {}-{}", major(file.st_rdev), minor(file.st_rdev));
}

// Returns this card's file that the previous process kept; null if there is none.
DrmFile takeKept(const std::string& path, KeptFiles& kept_files) {
  auto file = std::make_shared<DeviceFile>(kept_files.take(keptName(path)));
  struct stat kept {
  }, there{};
  const bool same = file->valid() && ::fstat(file->get(), &kept) == 0 &&
                    ::stat(path.c_str(), &there) == 0 && kept.st_rdev == there.st_rdev;
  return same ? file : nullptr;
}

class DrmCard final : public Card {
 public:
  DrmCard(std::string path, DrmFile file, UniqueFd wake, KeptFiles& kept_files)
      : path_(std::move(path)),
        file_(std::move(file)),
        wake_(std::move(wake)),
        kept_files_(kept_files) {}
  ~DrmCard() override;
  DrmCard(const DrmCard&) = delete;
  DrmCard& operator=(const DrmCard&) = delete;

  static Result<DrmFile> openFile(const std::string& path);
  // Continues with the file and the frame buffers of the previous process.
  void inherit();

  const std::string& path() const override { return path_; }
  Result<CardContents> look(bool probe) override;
  Result<std::shared_ptr<Buffer>> makeBuffer(int width, int height) override {
    return makeDumbBuffer(file_, width, height);
  }
  bool becomeMaster() override;
  bool isMaster() const override { return drmIsMaster(fd()) != 0; }
  std::vector<std::string> others() const override { return programsWith(path_); }
  CommitResult commit(std::span<const Lit> lit, bool test_only) override;
  std::vector<Flip> wait(Duration longest) override;
  void wake() override {
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = ::write(wake_.get(), &one, sizeof one);
  }
  std::shared_ptr<Scanout> scanout() override { return makeDrmScanout(file_, path_); }
  bool hasVblank(Id crtc) const override {
    std::uint64_t sequence = 0, ns = 0;
    return drmCrtcGetSequence(fd(), crtc, &sequence, &ns) == 0;
  }

 private:
  struct Setting {
    Id object;
    std::uint32_t type;
    const char* property;
    std::uint64_t value;
  };

  int fd() const { return file_->get(); }
  Id primaryPlane(std::size_t crtc, const std::set<Id>& used);
  Connector describe(const drmModeConnector& found);
  std::vector<Setting> settingsOf(const Lit& lit, std::uint32_t blob) const;
  // Returns the settings that switch off all that is not the wall's, also other connectors at a
  // CRTC that the wall uses.
  std::vector<Setting> offSettings(std::span<const Lit> lit);
  std::uint32_t blobOf(const Lit& lit);
  void readEvents();
  void dropInherited();

  std::string path_;
  DrmFile file_;
  UniqueFd wake_;
  KeptFiles& kept_files_;
  DrmProperties properties_;
  bool was_master_ = false;
  const std::string kept_name_ = keptName(path_);
  bool is_kept_ = false;       // kept_files_ keeps file_
  bool is_inherited_ = false;  // file_ was opened by the previous process
  bool is_gone_ = false;       // the card no longer exists
  // Frame buffers of the previous process, until no display shows them any more.
  std::vector<Id> inherited_;
  std::vector<Id> crtcs_, connectors_, planes_;
  std::map<Id, std::vector<drmModeModeInfo>> modes_;  // by connector
  std::map<Id, Id> lit_;  // connectors by the CRTCs that the wall has lit
  DrmSavedState saved_;
  std::vector<Flip> flips_;  // filled by readEvents()
};

// While systemd keeps the file, the card stays open and shows the last picture. Once nobody has the
// card open, the kernel restores its console.
DrmCard::~DrmCard() {
  if (is_kept_ && is_gone_) kept_files_.forget(kept_name_);
  file_->stays_shown = is_kept_;
  if (is_kept_) return;
  if (drmIsMaster(fd())) saved_.restore(fd());
  drmDropMaster(fd());
}

void DrmCard::inherit() {
  const auto resources = resourcesOf(fd());
  if (resources) inherited_.assign(resources->fbs, resources->fbs + resources->count_fbs);
  is_kept_ = true;
  is_inherited_ = true;
  // Saves nothing: what the displays showed before both processes is unknown.
  was_master_ = isMaster();
}

// Removes only frame buffers that no display shows: the kernel would switch that display off.
void DrmCard::dropInherited() {
  if (inherited_.empty()) return;
  std::set<Id> shown;
  for (const Id id : planes_) {
    if (const auto plane = planeOf(fd(), id)) shown.insert(plane->fb_id);
  }
  std::erase_if(inherited_, [&](Id buffer) {
    return shown.count(buffer) == 0 && drmModeRmFB(fd(), buffer) == 0;
  });
}

Result<DrmFile> DrmCard::openFile(const std::string& path) {
  auto file = std::make_shared<DeviceFile>(::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK));
  if (!file->valid() && errno == EACCES) {
    return Error{Errc::kIo, fmt::format("no permission to open {}; the user who runs merlind must "
                                        "be in the group that owns it, mostly video",
                                        path)};
  }
  if (!file->valid())
    return Error{Errc::kIo, fmt::format("cannot open {}: {}", path, errnoText(errno))};
  std::uint64_t dumb = 0;
  if (drmGetCap(file->get(), DRM_CAP_DUMB_BUFFER, &dumb) != 0)
    return Error{Errc::kUnsupported, fmt::format("{} is not a graphics card", path)};
  if (dumb == 0 || drmSetClientCap(file->get(), DRM_CLIENT_CAP_ATOMIC, 1) != 0)
    return Error{
        Errc::kUnsupported,
        fmt::format("the driver of {} has no atomic mode setting or no dumb buffers", path)};
  return file;
}

// A process that opens a card without a master becomes its master. Without root, a file that was
// never master, or that another process opened, may not ask to become it (EACCES): then the card is
// opened again. Buffers stay with the file through which they were made.
bool DrmCard::becomeMaster() {
  if (!isMaster()) dropMasterElsewhere(path_, fd());
  if (!isMaster() && drmSetMaster(fd()) != 0) {
    if (errno != EACCES || (was_master_ && !is_inherited_)) return false;
    auto again = openFile(path_);
    if (!again) return false;
    file_ = *std::move(again);
    is_kept_ = is_inherited_ = false;
    inherited_.clear();
    if (!isMaster()) return false;
  }
  if (!is_kept_) is_kept_ = kept_files_.keep(kept_name_, fd());
  if (!std::exchange(was_master_, true)) saved_ = DrmSavedState(fd(), properties_);
  return true;
}

// Returns a primary plane that the CRTC can show, that takes the buffers' format and is not used
// yet; 0 if there is none.
Id DrmCard::primaryPlane(std::size_t crtc, const std::set<Id>& used) {
  for (const Id id : planes_) {
    const auto plane = planeOf(fd(), id);
    if (!plane || used.count(id) > 0 || !(plane->possible_crtcs >> crtc & 1)) continue;
    const std::span formats(plane->formats, plane->count_formats);
    const auto type = properties_.valueOf(fd(), id, DRM_MODE_OBJECT_PLANE, "type");
    if (type == DRM_PLANE_TYPE_PRIMARY &&
        std::ranges::find(formats, std::uint32_t{DRM_FORMAT_XRGB8888}) != formats.end())
      return id;
  }
  return 0;
}

Result<CardContents> DrmCard::look(bool probe) {
  const auto resources = resourcesOf(fd());
  is_gone_ = !resources;
  if (is_gone_)
    return Error{Errc::kIo, fmt::format("{} is not there any more: {}", path_, errnoText(errno))};
  CardContents contents;
  contents.crtcs.assign(resources->crtcs, resources->crtcs + resources->count_crtcs);
  if (planes_.empty()) {
    const Owned<drmModePlaneRes> planes(drmModeGetPlaneResources(fd()), drmModeFreePlaneResources);
    if (planes) planes_.assign(planes->planes, planes->planes + planes->count_planes);
  }
  dropInherited();
  std::set<Id> used;
  for (std::size_t i = 0; i < contents.crtcs.size(); ++i) {
    contents.primary_planes.push_back(primaryPlane(i, used));
    used.insert(contents.primary_planes.back());
  }
  crtcs_ = contents.crtcs;
  connectors_.assign(resources->connectors, resources->connectors + resources->count_connectors);
  for (const Id id : connectors_) {
    const auto found = connectorOf(fd(), id, probe);
    if (found && found->connector_type != DRM_MODE_CONNECTOR_WRITEBACK)
      contents.connectors.push_back(describe(*found));
  }
  return contents;
}

Connector DrmCard::describe(const drmModeConnector& found) {
  const Id id = found.connector_id;
  const char* const kind = drmModeGetConnectorTypeName(found.connector_type);
  Connector connector{
      .id = id,
      .name = fmt::format("{}-{}", kind ? kind : "Unknown", found.connector_type_id),
      .connected = found.connection == DRM_MODE_CONNECTED,
      .link_bad = properties_.valueOf(fd(), id, DRM_MODE_OBJECT_CONNECTOR, "link-status") ==
                  DRM_MODE_LINK_STATUS_BAD};
  auto& modes = modes_[id];
  modes.assign(found.modes, found.modes + found.count_modes);
  for (std::size_t i = 0; i < modes.size(); ++i)
    connector.modes.push_back(modeOf(modes[i], static_cast<int>(i)));
  for (int i = 0; i < found.count_encoders; ++i) {
    const Owned<drmModeEncoder> encoder(drmModeGetEncoder(fd(), found.encoders[i]),
                                        drmModeFreeEncoder);
    if (encoder) connector.crtcs |= encoder->possible_crtcs;
  }
  return connector;
}

std::uint32_t DrmCard::blobOf(const Lit& lit) {
  const auto& modes = modes_[lit.connector];
  const auto index = static_cast<std::size_t>(lit.mode.index);
  std::uint32_t blob = 0;
  if (index < modes.size())
    drmModeCreatePropertyBlob(fd(), &modes[index], sizeof modes[index], &blob);
  return blob;
}

std::vector<DrmCard::Setting> DrmCard::settingsOf(const Lit& lit, std::uint32_t blob) const {
  constexpr auto kPlane = DRM_MODE_OBJECT_PLANE;
  std::vector<Setting> settings = {{lit.plane, kPlane, "FB_ID", lit.buffer}};
  if (!lit.sets_mode) return settings;
  const auto width = static_cast<std::uint64_t>(lit.mode.width);
  const auto height = static_cast<std::uint64_t>(lit.mode.height);
  settings.insert(settings.end(), {{lit.connector, DRM_MODE_OBJECT_CONNECTOR, "CRTC_ID", lit.crtc},
                                   {lit.connector, DRM_MODE_OBJECT_CONNECTOR, "link-status",
                                    DRM_MODE_LINK_STATUS_GOOD},
                                   {lit.crtc, DRM_MODE_OBJECT_CRTC, "MODE_ID", blob},
                                   {lit.crtc, DRM_MODE_OBJECT_CRTC, "ACTIVE", 1},
                                   {lit.plane, kPlane, "CRTC_ID", lit.crtc},
                                   {lit.plane, kPlane, "SRC_X", 0},
                                   {lit.plane, kPlane, "SRC_Y", 0},
                                   {lit.plane, kPlane, "SRC_W", width << 16},  // 16.16 fixed point
                                   {lit.plane, kPlane, "SRC_H", height << 16},
                                   {lit.plane, kPlane, "CRTC_X", 0},
                                   {lit.plane, kPlane, "CRTC_Y", 0},
                                   {lit.plane, kPlane, "CRTC_W", width},
                                   {lit.plane, kPlane, "CRTC_H", height}});
  return settings;
}

std::vector<DrmCard::Setting> DrmCard::offSettings(std::span<const Lit> lit) {
  std::map<Id, Id> ours = lit_;
  std::set<Id> connectors, crtcs, planes;
  for (const Lit& l : lit) {
    ours[l.crtc] = l.connector;
    planes.insert(l.plane);
  }
  for (const auto& [crtc, connector] : ours) {
    crtcs.insert(crtc);
    connectors.insert(connector);
  }
  std::vector<Setting> off;
  for (const Id id : connectors_) {
    if (connectors.count(id) == 0) off.push_back({id, DRM_MODE_OBJECT_CONNECTOR, "CRTC_ID", 0});
  }
  for (const Id id : crtcs_) {
    if (crtcs.count(id) > 0) continue;
    off.push_back({id, DRM_MODE_OBJECT_CRTC, "ACTIVE", 0});
    off.push_back({id, DRM_MODE_OBJECT_CRTC, "MODE_ID", 0});
  }
  for (const Id id : planes_) {
    const auto crtc = properties_.valueOf(fd(), id, DRM_MODE_OBJECT_PLANE, "CRTC_ID");
    const bool ours_elsewhere = crtc && lit_.count(static_cast<Id>(*crtc)) > 0;
    if (planes.count(id) > 0 || ours_elsewhere || crtc == 0u) continue;
    off.push_back({id, DRM_MODE_OBJECT_PLANE, "FB_ID", 0});
    off.push_back({id, DRM_MODE_OBJECT_PLANE, "CRTC_ID", 0});
  }
  return off;
}

CommitResult DrmCard::commit(std::span<const Lit> lit, bool test_only) {
  const bool sets_mode = std::ranges::any_of(lit, &Lit::sets_mode);
  std::vector<Setting> settings;
  if (sets_mode) settings = offSettings(lit);
  std::vector<std::uint32_t> blobs;
  for (const Lit& l : lit) {
    if (l.sets_mode) blobs.push_back(blobOf(l));
    const auto more = settingsOf(l, l.sets_mode ? blobs.back() : 0);
    settings.insert(settings.end(), more.begin(), more.end());
  }
  const Owned<drmModeAtomicReq> request(drmModeAtomicAlloc(), drmModeAtomicFree);
  for (const Setting& s : settings) {
    const std::uint32_t property = properties_.idOf(fd(), s.object, s.type, s.property);
    if (property != 0) drmModeAtomicAddProperty(request.get(), s.object, property, s.value);
  }
  std::uint32_t flags = sets_mode ? DRM_MODE_ATOMIC_ALLOW_MODESET : 0;
  flags |=
      test_only ? DRM_MODE_ATOMIC_TEST_ONLY : DRM_MODE_ATOMIC_NONBLOCK | DRM_MODE_PAGE_FLIP_EVENT;
  // Marks the events of our commits; those with another value belong to a commit of the previous
  // process.
  void* const ours = reinterpret_cast<void*>(static_cast<std::uintptr_t>(::getpid()));
  const int rc = drmModeAtomicCommit(fd(), request.get(), flags, ours);
  const int error = rc != 0 ? errno : 0;
  for (const std::uint32_t blob : blobs) drmModeDestroyPropertyBlob(fd(), blob);
  if (rc == 0 && !test_only)
    for (const Lit& l : lit) lit_[l.crtc] = l.connector;
  switch (error) {
    case 0: return {};
    case EBUSY: return {Committed::kBusy};
    case EACCES:
    case EPERM: return {Committed::kNotMaster};
    case ENODEV:
      is_gone_ = true;
      return {Committed::kGone, fmt::format("{} is not there any more", path_)};
    default: return {Committed::kRefused, errnoText(error)};
  }
}

// The kernel hands out whole events only.
void DrmCard::readEvents() {
  std::array<char, 1024> events{};
  const ssize_t size = ::read(fd(), events.data(), events.size());
  drm_event event{};
  for (std::size_t at = 0; size > 0 && at + sizeof event <= static_cast<std::size_t>(size);
       at += std::max<std::size_t>(event.length, sizeof event)) {
    std::memcpy(&event, &events[at], sizeof event);
    drm_event_vblank flip{};
    if (event.type != DRM_EVENT_FLIP_COMPLETE || event.length < sizeof flip) continue;
    std::memcpy(&flip, &events[at], sizeof flip);
    if (flip.user_data != static_cast<std::uint64_t>(::getpid())) continue;
    const auto when = std::chrono::seconds(flip.tv_sec) + std::chrono::microseconds(flip.tv_usec);
    flips_.push_back({flip.crtc_id, Timestamp(when)});
  }
}

std::vector<Flip> DrmCard::wait(Duration longest) {
  pollfd waits[] = {{fd(), POLLIN, 0}, {wake_.get(), POLLIN, 0}};
  const auto timeout = std::chrono::ceil<std::chrono::milliseconds>(longest);
  if (::poll(waits, std::size(waits), static_cast<int>(timeout.count())) <= 0) return {};
  if (waits[1].revents & POLLIN) {
    std::uint64_t count = 0;
    [[maybe_unused]] const auto read = ::read(wake_.get(), &count, sizeof count);
  }
  if (waits[0].revents & POLLIN) readEvents();
  return std::exchange(flips_, {});
}

// Returns the cards in the order of the numbers in their names, in which the kernel found them.
std::vector<std::string> cardPaths() {
  std::map<int, std::string> paths;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/dev/dri", ignored)) {
    constexpr std::string_view kPrefix = "card";
    const std::string name = entry.path().filename();
    if (!name.starts_with(kPrefix)) continue;
    int number = 0;
    const char* const from = name.data() + kPrefix.size();
    if (std::from_chars(from, name.data() + name.size(), number).ec == std::errc())
      paths[number] = entry.path();
  }
  std::vector<std::string> sorted;
  for (const auto& [number, path] : paths) sorted.push_back(path);
  return sorted;
}

bool hasConnectors(int fd) {
  const auto resources = resourcesOf(fd);
  return resources && resources->count_connectors > 0;
}

// `kept`: the previous process kept this file.
Result<std::unique_ptr<Card>> makeCard(const std::string& path, DrmFile file, bool kept,
                                       KeptFiles& kept_files) {
  UniqueFd wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!wake.valid()) return Error{Errc::kIo, fmt::format("eventfd: {}", errnoText(errno))};
  auto card = std::make_unique<DrmCard>(path, std::move(file), std::move(wake), kept_files);
  if (kept) card->inherit();
  return std::unique_ptr<Card>(std::move(card));
}

Result<std::unique_ptr<Card>> openCard(const std::string& path, KeptFiles& kept_files) {
  DrmFile kept = takeKept(path, kept_files);
  if (kept) return makeCard(path, std::move(kept), true, kept_files);
  auto file = DrmCard::openFile(path);
  if (!file) return file.error();
  if (!hasConnectors((*file)->get()))
    return Error{Errc::kNotFound, fmt::format("{} has no connector", path)};
  return makeCard(path, *std::move(file), false, kept_files);
}

}  // namespace

Result<std::unique_ptr<Card>> openDrmCard(const std::string& path, KeptFiles& kept_files) {
  const std::vector<std::string> paths = cardPaths();
  if (!path.empty()) {
    std::error_code error;
    const fs::path real = fs::canonical(path, error);  // /dev/dri/by-path/... is a link
    if (error) {
      return Error{Errc::kNotFound,
                   fmt::format("there is no card {}; this machine has {}", path,
                               paths.empty() ? "none in /dev/dri"
                                             : fmt::format("{}", fmt::join(paths, ", ")))};
    }
    return openCard(real, kept_files);
  }
  Error reason{Errc::kNotFound, "this machine has no graphics card (/dev/dri/card*)"};
  for (const std::string& candidate : paths) {
    auto card = openCard(candidate, kept_files);
    if (card) return card;
    reason = card.error();
  }
  return reason;
}

}  // namespace merlin::render::out::kms
