#include "render/out/kms/displays.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "render/out/kms/choice.h"

namespace merlin::render::out::kms {
namespace {

constexpr Duration kLookEvery = std::chrono::seconds(1);
constexpr Duration kRetryRefused = std::chrono::seconds(10);
// If a display has not shown a committed frame after this time, its mode is set again.
constexpr Duration kOverdue = std::chrono::seconds(1);
constexpr Duration kBusyPause = std::chrono::milliseconds(2);
constexpr std::size_t kProgramsNamed = 2;

std::vector<Lit> litOf(const auto& shares) {
  std::vector<Lit> lit;
  for (const auto& share : shares) lit.push_back(share.lit);
  return lit;
}

}  // namespace

Displays::Displays(OpenCard open, const Clock& clock) : open_(std::move(open)), clock_(clock) {}

// Closes the card first: it restores what its displays showed before, while the buffers that they
// show now still exist.
Displays::~Displays() { card_.reset(); }

std::size_t Displays::add(const KmsSettings& settings, int picture_width, int picture_height) {
  const std::size_t count = settings.isEvery() ? kMostOfEvery : 1;
  for (std::size_t n = 0; n < count; ++n) {
    Screen& screen = screens_.emplace_back();
    screen.settings = settings;
    screen.output = outputs_;
    if (settings.isEvery()) screen.nth = n;
    screen.width = picture_width;
    screen.height = picture_height;
  }
  return outputs_++;
}

std::string Displays::fault(std::size_t i) const {
  const std::lock_guard lock(mutex_);
  return faultOf(i);
}

// Returns the faults of the output's displays; a fault that several displays share appears once.
std::string Displays::faultOf(std::size_t output) const {
  std::set<std::string> faults;
  for (const Screen& screen : screens_)
    if (screen.output == output && !screen.fault.empty()) faults.insert(screen.fault);
  return fmt::format("{}", fmt::join(faults, "; "));
}

bool Displays::wantsFrame(std::size_t i) const {
  return std::ranges::any_of(
      screens_, [i](const Screen& s) { return s.output == i && s.wants_frame.load(); });
}

std::optional<Displays::Blanks> Displays::blanks() const {
  const std::int64_t last = vblank_ns_, period = period_ns_;
  if (last == 0 || period == 0) return std::nullopt;
  return Blanks{fromNanoseconds(last), Duration(period)};
}

void Displays::step(Duration longest) {
  const Timestamp now = clock_.now();
  if (!card_ && (now < next_look_ || !openCard())) {
    std::unique_lock lock(mutex_);
    idle_.wait_for(lock, longest);
    return;
  }
  if (now >= next_look_) look(now);
  if (!card_) return;
  lightAskedFor();
  commit(now);
  take(card_->wait(busy_ ? std::min(longest, kBusyPause) : longest));
  checkOverdue(clock_.now());
}

void Displays::wake() {
  const std::lock_guard lock(mutex_);
  if (card_) card_->wake();
  idle_.notify_all();
}

void Displays::awaitFirstLook(Duration longest) {
  std::unique_lock lock(mutex_);
  idle_.wait_for(lock, longest, [this] { return looked_; });
}

bool Displays::openCard() {
  next_look_ = clock_.now() + kLookEvery;
  auto opened = open_();
  const std::lock_guard lock(mutex_);
  looked_ = true;
  idle_.notify_all();
  if (!opened) {
    darkenAll(opened.error().what);
    if (opened.error().code == Errc::kNotFound)
      for (Screen& screen : screens_)
        if (screen.nth) screen.fault.clear();
    return false;
  }
  card_ = *std::move(opened);
  next_look_ = {};
  return true;
}

void Displays::closeCard(const std::string& why) {
  const std::lock_guard lock(mutex_);
  scanout_.reset();
  card_.reset();
  master_ = false;
  connected_.clear();
  for (Screen& screen : screens_) screen.place.reset();
  vblank_ns_ = 0;
  darkenAll(why);
}

// Looks for displays only as DRM master, since only the master can light them.
void Displays::look(Timestamp now) {
  next_look_ = now + kLookEvery;
  if (!holdMaster()) return;
  auto contents = card_->look(false);
  if (contents && hasNewDisplay(*contents)) contents = card_->look(true);
  if (!contents) return closeCard(contents.error().what);
  arrange(*contents, now);
}

bool Displays::holdMaster() {
  const bool is = card_->isMaster();
  if (is && master_) return true;
  // A program that takes the displays from us needs a moment between our losing master and its
  // becoming master, so only the next look tries to become master again.
  const bool lost = master_ && !is;
  const bool became = !lost && card_->becomeMaster();
  const std::string taken = became ? std::string() : takenMessage();
  const std::lock_guard lock(mutex_);
  master_ = became;
  scanout_ = became ? card_->scanout() : nullptr;
  // Another program may have set other modes meanwhile: arrange() lights all displays again.
  for (Screen& screen : screens_) screen.lit = false;
  if (!became) {
    looked_ = true;
    idle_.notify_all();
    darkenAll(taken);
  }
  return became;
}

std::string Displays::takenMessage() const {
  std::vector<std::string> others = card_->others();
  const std::size_t more = others.size() > kProgramsNamed ? others.size() - kProgramsNamed : 0;
  others.resize(others.size() - more);
  if (others.empty())
    return fmt::format("another program has the displays of {}; its name cannot be seen from here",
                       card_->path());
  return fmt::format("another program has the displays of {}: {}{}; the wall returns when it ends",
                     card_->path(), fmt::join(others, ", "),
                     more > 0 ? fmt::format(" and {} more", more) : "");
}

// Returns whether a display was plugged in since the last look, so that its modes are not known
// yet.
bool Displays::hasNewDisplay(const CardContents& contents) {
  std::set<Id> connected;
  for (const Connector& connector : contents.connectors)
    if (connector.connected) connected.insert(connector.id);
  const bool has = !std::ranges::includes(connected_, connected);
  connected_ = std::move(connected);
  return has;
}

// Returns the index of a connector for each screen. An output of all connectors takes those that no
// other output names, in the card's order, whether they have a display or not: so no display
// changes its screen when another one is unplugged.
std::vector<Result<std::size_t>> Displays::chooseConnectors(const CardContents& contents) const {
  std::set<std::string> named;
  for (const Screen& screen : screens_) named.insert(screen.settings.connector);
  std::vector<std::size_t> free;
  for (std::size_t c = 0; c < contents.connectors.size(); ++c)
    if (named.count(contents.connectors[c].name) == 0) free.push_back(c);
  std::vector<Result<std::size_t>> chosen;
  for (const Screen& screen : screens_) {
    if (!screen.nth) {
      chosen.push_back(
          chooseConnector(contents.connectors, screen.settings.connector, card_->path()));
    } else if (*screen.nth < free.size()) {
      chosen.emplace_back(free[*screen.nth]);
    } else {
      chosen.emplace_back(Error{Errc::kNotFound, ""});  // an empty text: this is no fault
    }
  }
  return chosen;
}

void Displays::arrange(const CardContents& contents, Timestamp now) {
  const std::vector<Result<std::size_t>> chosen = chooseConnectors(contents);
  std::vector<std::uint32_t> masks;
  for (std::size_t i = 0; i < screens_.size(); ++i) {
    const Connector* const c = chosen[i] ? &contents.connectors[*chosen[i]] : nullptr;
    // In an output of all connectors, one without a display needs no CRTC; one that had a display
    // keeps its CRTC.
    const bool needs_none = c && screens_[i].nth && !c->connected && !screens_[i].place;
    masks.push_back(c && !needs_none ? c->crtcs : 0);
  }
  std::uint32_t usable = 0;
  for (std::size_t i = 0; i < contents.primary_planes.size(); ++i)
    usable |= contents.primary_planes[i] != 0 ? std::uint32_t{1} << i : 0;
  const auto crtcs = assignCrtcs(masks, usable);
  for (std::size_t i = 0; i < screens_.size(); ++i) {
    Screen& screen = screens_[i];
    if (screen.retry_at && now < *screen.retry_at) continue;
    const Result<Ok> placed =
        chosen[i] ? place(screen, contents, contents.connectors[*chosen[i]], crtcs[i])
                  : Result<Ok>(chosen[i].error());
    const std::lock_guard lock(mutex_);
    screen.retry_at.reset();
    if (!placed) darken(screen, placed.error().what);
  }
  const std::lock_guard lock(mutex_);
  looked_ = true;
  idle_.notify_all();
}

// Finds the mode and makes the buffers, which stay as long as the mode does.
Result<Ok> Displays::place(Screen& screen, const CardContents& contents, const Connector& connector,
                           std::optional<std::size_t> crtc) {
  if (!connector.connected && screen.nth) return Error{Errc::kNotFound, ""};  // no fault
  if (!connector.connected) {
    return Error{Errc::kNotFound,
                 fmt::format("nothing is plugged in at {} of {}", connector.name, card_->path())};
  }
  if (!crtc) {
    return Error{Errc::kUnsupported,
                 fmt::format("{} has no CRTC left for {}: it can drive {} displays at a time",
                             card_->path(), connector.name, contents.crtcs.size())};
  }
  const auto index = chooseMode(connector, screen.settings.mode, screen.width, screen.height);
  if (!index) return index.error();
  const Mode& mode = connector.modes[*index];
  const Place* const had = screen.place.get();
  const bool same = had && had->connector == connector.id && had->crtc == contents.crtcs[*crtc] &&
                    had->mode.sameTiming(mode);
  if (same) {
    const std::lock_guard lock(mutex_);
    screen.place->mode = mode;  // its index in the list may have changed
    if (!screen.lit || connector.link_bad) lightAgain(screen);
    return Ok{};
  }
  auto fresh = std::make_shared<Place>(Place{.connector = connector.id,
                                             .crtc = contents.crtcs[*crtc],
                                             .plane = contents.primary_planes[*crtc],
                                             .mode = mode,
                                             .name = connector.name});
  for (auto& buffer : fresh->buffers) {
    auto made = card_->makeBuffer(mode.width, mode.height);
    if (!made) return made.error();
    buffer = *std::move(made);
  }
  const std::lock_guard lock(mutex_);
  screen.place = std::move(fresh);
  lightAgain(screen);
  return Ok{};
}

void Displays::lightAgain(Screen& screen) {
  screen.place->turns.drop();  // a frame that waits is outdated
  screen.lit = true;
  screen.sets_mode = true;
  screen.fault.clear();
  screen.wants_frame = true;
}

// The CRTC keeps what the display last showed: this costs nothing, and a projector that is switched
// on again shows it at once.
void Displays::darken(Screen& screen, const std::string& fault) {
  screen.lit = false;
  screen.wants_frame = false;
  screen.fault = fault;
  if (screen.place && screen.place->turns.isPending()) screen.place->turns.flipped();
}

void Displays::darkenAll(const std::string& fault) {
  for (Screen& screen : screens_) darken(screen, fault);
}

// Commits all displays together, one commit at a time, so that they change in the same frame.
void Displays::commit(Timestamp now) {
  std::vector<Share> shares;
  {
    const std::lock_guard lock(mutex_);
    busy_ = false;
    shares = dueShares();
    for (const Share& share : shares) share.screen->place->turns.commit();
  }
  if (shares.empty()) return;
  const CommitResult result = card_->commit(litOf(shares), false);
  settle(shares, result, now);
}

std::vector<Displays::Share> Displays::dueShares() {
  std::vector<Share> shares;
  if (!master_ || !whole_) return shares;
  for (Screen& screen : screens_) {
    if (!screen.lit) continue;
    const Place& place = *screen.place;
    if (place.turns.isPending()) return {};
    const auto ready = place.turns.ready();
    if (!ready) continue;
    shares.push_back({&screen,
                      {place.connector, place.crtc, place.plane, place.buffers[*ready]->id(),
                       place.mode, screen.sets_mode}});
  }
  return shares;
}

void Displays::settle(std::vector<Share>& shares, const CommitResult& result, Timestamp now) {
  if (result.outcome == Committed::kGone) return closeCard(result.why);
  const std::string taken =
      result.outcome == Committed::kNotMaster ? takenMessage() : std::string();
  {
    const std::lock_guard lock(mutex_);
    for (const Share& share : shares) {
      if (result.outcome == Committed::kDone)
        share.screen->sets_mode = false;
      else
        share.screen->place->turns.uncommit();
    }
    committed_ = now;
    busy_ = result.outcome == Committed::kBusy;
    if (result.outcome == Committed::kNotMaster) {
      master_ = false;
      next_look_ = now + kLookEvery;
      darkenAll(taken);
    }
  }
  if (result.outcome == Committed::kRefused) refuse(shares, result.why, now);
}

// Finds the displays that the card refuses, alone or together with the others, and leaves them out;
// the others are committed in the next step.
void Displays::refuse(std::vector<Share>& shares, const std::string& why, Timestamp now) {
  const auto takes = [&](std::span<const Lit> lit) {
    return card_->commit(lit, true).outcome == Committed::kDone;
  };
  std::vector<Lit> accepted;
  struct Refused {
    Screen* screen;
    bool alone;
  };
  std::vector<Refused> refused;
  for (const Share& share : shares) {
    accepted.push_back(share.lit);
    if (takes(accepted)) continue;
    accepted.pop_back();
    refused.push_back({share.screen, !takes({&share.lit, 1})});
  }
  // No test found the reason for the refusal, so all displays are dropped and lit again later.
  if (refused.empty())
    for (const Share& share : shares) refused.push_back({share.screen, false});
  const std::lock_guard lock(mutex_);
  for (const auto& [screen, alone] : refused) {
    const Place& place = *screen->place;
    // If only a buffer was refused, another program has set another mode: the next look sets ours.
    if (screen->sets_mode) screen->retry_at = now + kRetryRefused;
    darken(*screen, fmt::format("the card refuses {}x{}@{:.0f} at {}{}: {}", place.mode.width,
                                place.mode.height, place.mode.refresh_hz, place.name,
                                alone ? "" : " beside the other displays", why));
  }
}

void Displays::take(const std::vector<Flip>& flips) {
  const std::lock_guard lock(mutex_);
  for (const Flip& flip : flips) {
    const auto screen = std::ranges::find_if(
        screens_, [&](const Screen& s) { return s.place && s.place->crtc == flip.crtc; });
    if (screen == screens_.end()) continue;
    screen->place->turns.flipped();
    const auto first = std::ranges::find_if(
        screens_, [&](const Screen& s) { return s.lit && card_->hasVblank(s.place->crtc); });
    if (first != screen || screen->place->mode.refresh_hz <= 0) continue;
    period_ns_ = fromSeconds(1 / screen->place->mode.refresh_hz).count();
    vblank_ns_ = toNanoseconds(flip.when);
  }
}

void Displays::checkOverdue(Timestamp now) {
  const std::lock_guard lock(mutex_);
  if (now - committed_ < kOverdue) return;
  for (Screen& screen : screens_) {
    if (!screen.lit || !screen.place->turns.isPending()) continue;
    darken(screen,
           fmt::format("{} has shown no frame for a second; it is lit again", screen.place->name));
  }
}

}  // namespace merlin::render::out::kms
