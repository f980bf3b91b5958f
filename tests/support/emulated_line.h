// EmulatedLine: an emulated device that runs in its own thread at one end of a socket pair. The
// test can make the line fail: pulled, babbling or frozen. Uses real time and real descriptors.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include "daemon/base/random.h"
#include "daemon/base/unique_fd.h"
#include "drivers/emulate/emulator.h"
#include "drivers/io/fd_stream.h"

namespace merlin::test {

enum class Fault {
  kNone,
  kPulled,    // the port is gone: open connections end, open() fails
  kBabbling,  // the device sends random bytes at 115200 baud and ignores its input
  kFrozen,    // the device sends nothing and ignores its input
};

class EmulatedLine {
 public:
  EmulatedLine(const char* device, const emulate::EmulatorSettings& settings,
               const char* script_name)
      : script_(*emulate::findMotionScript(script_name)),
        emulator_(emulate::findEmulator(device)->make(settings, script_, clock_.now())),
        wake_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)),
        thread_([this](const std::stop_token& stop) { serve(stop); }) {}
  ~EmulatedLine() {
    thread_.request_stop();
    wake();
  }
  EmulatedLine(const EmulatedLine&) = delete;
  EmulatedLine& operator=(const EmulatedLine&) = delete;

  // Opens a new connection, which replaces the previous one. Errors: kNotFound while the line is
  // pulled; kIo if there is no socket pair.
  Result<std::unique_ptr<ByteStream>> open() {
    int ends[2];
    writes_ = 0;
    if (fault_ == Fault::kPulled) return Error{Errc::kNotFound, "the line is pulled"};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends) != 0)
      return Error{Errc::kIo, "no socket pair"};
    {
      const std::lock_guard lock(mutex_);
      device_end_.reset(ends[0]);
    }
    wake();
    auto inner = std::make_unique<io::FdStream>(ends[1], [fd = ends[1]] { (void)::close(fd); });
    return std::unique_ptr<ByteStream>(std::make_unique<Counting>(*this, std::move(inner)));
  }

  // Closes the connection, so that the driver reconnects. `fault` begins once the driver has
  // written `writes` times on the new connection; the device still receives the last of these
  // writes.
  void failInDialogue(Fault fault, int writes) {
    armed_fault_ = fault;
    armed_writes_ = writes;
    cut();
  }
  void fail(Fault fault) {
    fault_ = fault;
    if (fault == Fault::kPulled) cut();
    wake();
  }
  void mend() {
    armed_writes_ = -1;
    fault_ = Fault::kNone;
    wake();
  }
  Fault fault() const { return fault_; }
  // Number of writes by the driver since it last opened the line.
  int writes() const { return writes_; }

 private:
  // The driver's end of the connection; counts the driver's writes.
  class Counting final : public ByteStream {
   public:
    Counting(EmulatedLine& line, std::unique_ptr<ByteStream> inner)
        : line_(line), inner_(std::move(inner)) {
      line_.step();
    }
    Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override {
      return inner_->read(buffer, timeout);
    }
    Result<std::size_t> write(std::span<const std::byte> bytes, Duration timeout) override {
      auto written = inner_->write(bytes, timeout);
      ++line_.writes_;
      line_.step();
      return written;
    }
    void interrupt() noexcept override { inner_->interrupt(); }

   private:
    EmulatedLine& line_;
    std::unique_ptr<ByteStream> inner_;
  };

  void step() {
    if (writes_ == armed_writes_) {
      armed_writes_ = -1;
      fail(armed_fault_);
    }
  }
  void cut() {
    {
      const std::lock_guard lock(mutex_);
      device_end_.reset();
    }
    wake();
  }
  void wake() { (void)::eventfd_write(wake_.get(), 1); }

  void serve(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      int fd = -1;
      {
        const std::lock_guard lock(mutex_);
        if (device_end_.valid()) fd = ::dup(device_end_.get());
      }
      const UniqueFd line(fd);
      for (std::uint64_t served = generation_; !stop.stop_requested() && served == generation_;)
        round(line.get());
    }
  }

  // One step of the device: sends what is due, waits for input, and passes it to the emulator.
  // Returns early when open(), cut() or the destructor wakes the thread.
  void round(int fd) {
    std::string out;
    Timestamp next = clock_.now() + std::chrono::milliseconds(5);
    if (fault_ == Fault::kNone) {
      emulator_->advance(clock_.now(), out);
      next = emulator_->nextDue();
    } else if (fault_ == Fault::kBabbling) {
      for (int i = 0; i < 58; ++i) out.push_back(static_cast<char>(noise_.next()));
    }
    if (!out.empty() && fd >= 0) (void)::send(fd, out.data(), out.size(), MSG_NOSIGNAL);
    const Duration wait = std::max<Duration>(next - clock_.now(), Duration::zero());
    const timespec limit{wait / std::chrono::seconds(1), (wait % std::chrono::seconds(1)).count()};
    pollfd fds[] = {{wake_.get(), POLLIN, 0}, {fd, POLLIN, 0}};
    ::ppoll(fds, fd >= 0 && !hung_up_ ? 2 : 1, &limit, nullptr);
    eventfd_t ignored = 0;
    if (fds[0].revents) {
      (void)::eventfd_read(wake_.get(), &ignored);
      hung_up_ = false;
      ++generation_;
      return;
    }
    if (fd < 0 || !fds[1].revents) return;
    std::byte received[256];
    const ssize_t n = ::read(fd, received, sizeof received);
    // the driver closed its end, so there is nothing to read until open() is called again
    hung_up_ = n == 0;
    if (n > 0 && fault_ == Fault::kNone)
      emulator_->receive(std::span(received, static_cast<std::size_t>(n)), clock_.now());
  }

  SystemClock clock_;
  emulate::MotionScript script_;
  std::unique_ptr<emulate::Emulator> emulator_;
  Random noise_{7};
  UniqueFd wake_;
  std::mutex mutex_;
  UniqueFd device_end_;
  // The next two are used by the thread alone. The number is incremented when the thread has to
  // fetch device_end_ again.
  std::uint64_t generation_ = 0;
  bool hung_up_ = false;
  std::atomic<Fault> fault_{Fault::kNone}, armed_fault_{Fault::kNone};
  std::atomic<int> armed_writes_{-1}, writes_{0};
  std::jthread thread_;
};

}  // namespace merlin::test
