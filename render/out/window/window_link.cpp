#include "render/out/window/window_link.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>

#include "daemon/base/log.h"

namespace merlin::render::out {
namespace {

constexpr int kStep_ms = 200;

}  // namespace

WindowLink::WindowLink(WindowSettings settings, WindowActs acts, std::string program,
                       ThreadWatch& watch, const Clock& clock)
    : settings_(std::move(settings)),
      acts_(std::move(acts)),
      program_path_(std::move(program)),
      clock_(clock),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      thread_(watch, "window output",
              [this](const std::stop_token& stop, Progress& progress) { work(stop, progress); }) {}

WindowLink::~WindowLink() { thread_.stop(); }

bool WindowLink::isClosed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

std::string WindowLink::fault() const {
  const std::lock_guard lock(mutex_);
  return fault_;
}

// Only this thread changes newest_, and the slot sent next is always newest_, so the slot that is
// neither newest_ nor in flight stays free while it is written to.
Result<bool> WindowLink::show(int width, int height, std::span<const std::uint8_t> pixels) {
  std::uint32_t free = 0;
  {
    const std::lock_guard lock(mutex_);
    if (closed_) return Error{Errc::kClosed, fault_};
    if (!slots_) {
      auto made = PictureSlots::make(width, height);
      if (!made) return made.error();
      slots_.emplace(*std::move(made));
    }
    while (free == newest_ || free == in_flight_) ++free;
  }
  const auto to = slots_->slot(free);
  std::copy_n(pixels.begin(), std::min(to.size(), pixels.size()), to.begin());
  bool shown = false;
  std::string fault;
  {
    const std::lock_guard lock(mutex_);
    newest_ = free;
    const bool replaces = frames_ > sent_;  // the frame before may have been sent meanwhile
    ++frames_;
    shown = opened_ && !replaces;
    fault = fault_;
  }
  wake();
  if (!fault.empty()) return Error{Errc::kIo, fault};
  return shown;
}

WindowForm WindowLink::form() const {
  WindowForm form;
  copyText(settings_.title, form.title);
  form.monitor = settings_.monitor;
  form.x = settings_.x;
  form.y = settings_.y;
  form.width = settings_.width;
  form.height = settings_.height;
  form.fullscreen = settings_.fullscreen;
  form.border = settings_.border;
  form.fit = settings_.scale == WindowScale::kFit;
  form.input = settings_.input;
  form.picture_width = slots_->width();
  form.picture_height = slots_->height();
  if (acts_.panel) form.panel = *acts_.panel;
  return form;
}

void WindowLink::work(const std::stop_token& stop, Progress& progress) {
  const std::stop_callback wake_up(stop, [this] { wake(); });
  while (!stop.stop_requested()) {
    progress.step();
    await();
    const Timestamp now = clock_.now();
    if (process_) {
      takeEvents();
      checkIsAlive(now);
      sendNewest();
    } else {
      start(now);
    }
  }
  process_.reset();
}

// Starts the program when there is a first frame, unless a person closed the window.
void WindowLink::start(Timestamp now) {
  if (now < next_start_) return;
  int pictures = -1;
  {
    const std::lock_guard lock(mutex_);
    if (frames_ == 0 || closed_) return;
    pictures = slots_->fd();
    sent_ = 0;
  }
  next_start_ = now + kRetry;
  auto started = WindowProcess::start(program_path_, form(), pictures);
  if (!started) return fail(started.error().what);
  process_ = *std::move(started);
  owed_since_ = now;
}

void WindowLink::await() {
  std::array<pollfd, 2> fds = {
      {{wake_.get(), POLLIN, 0}, {process_ ? process_->socket() : -1, POLLIN, 0}}};
  ::poll(fds.data(), fds.size(), kStep_ms);
  std::uint64_t count = 0;
  if (fds[0].revents != 0 && ::read(wake_.get(), &count, sizeof count) < 0) return;
}

void WindowLink::takeEvents() {
  while (process_) {
    const auto event = process_->receive();
    if (!event)
      return fail(
          "the window's program has ended, most likely since its X server went away; it is started "
          "again every second");
    if (!*event) return;
    take(**event);
  }
}

void WindowLink::take(const WindowEvent& event) {
  const std::string text(textOf(event.text));
  switch (event.kind) {
    case WindowEvent::kOpened: {
      owed_since_.reset();
      const std::lock_guard lock(mutex_);
      opened_ = true;
      break;
    }
    case WindowEvent::kShown: {
      owed_since_.reset();
      const std::lock_guard lock(mutex_);
      fault_.clear();
      in_flight_ = newest_;  // that slot is not written to anyway, so the other two are free
      break;
    }
    case WindowEvent::kClosed: {
      fail("a person closed the window; restart merlind to open it again");
      {
        const std::lock_guard lock(mutex_);
        closed_ = true;
      }
      if (settings_.on_close == OnClose::kStop)
        acts_.stop(fmt::format("the window \"{}\" was closed", settings_.title));
      break;
    }
    case WindowEvent::kFault: fail(text); break;
    case WindowEvent::kCommand: execute(text); break;
  }
}

void WindowLink::execute(std::string_view command) const {
  const std::size_t space = std::min(command.find(' '), command.size());
  const auto done = acts_.command(std::string(command.substr(0, space)),
                                  std::string(command.substr(std::min(space + 1, command.size()))));
  if (!done) logWarning("a command that was given in a window failed: {}", done.error().what);
}

// Sends one frame at a time, so that the program always gets the newest one next.
void WindowLink::sendNewest() {
  if (!process_ || owed_since_) return;
  FrameReady frame;
  {
    const std::lock_guard lock(mutex_);
    if (!opened_ || sent_ == frames_) return;
    sent_ = frames_;
    in_flight_ = newest_;
    frame.slot = newest_;
  }
  owed_since_ = clock_.now();
  if (const auto sent = process_->send(frame); !sent) fail(sent.error().what);
}

void WindowLink::checkIsAlive(Timestamp now) {
  if (!process_ || !owed_since_ || now - *owed_since_ < kSlow) return;
  constexpr const char* kWhy =
      "the display does not answer: the window has taken no frame for {} s";
  const double waited_s = toSeconds(kSlow);
  if (now - *owed_since_ >= kStuck) return fail(fmt::format(kWhy, toSeconds(kStuck)));
  const std::lock_guard lock(mutex_);
  fault_ = fmt::format(kWhy, waited_s);
}

// Ends the program; it is started again not before kRetry after its last start.
void WindowLink::fail(const std::string& why) {
  process_.reset();
  owed_since_.reset();
  const std::lock_guard lock(mutex_);
  opened_ = false;
  fault_ = why;
}

void WindowLink::wake() const {
  const std::uint64_t one = 1;
  if (::write(wake_.get(), &one, sizeof one) < 0) return;  // it is already awake
}

}  // namespace merlin::render::out
