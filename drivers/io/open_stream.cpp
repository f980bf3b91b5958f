#include "drivers/io/open_stream.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <libserialport.h>
#include <sys/file.h>
#include <termios.h>

#include "drivers/io/evdev_stream.h"
#include "drivers/io/fd_stream.h"
#include "drivers/io/low_latency.h"
#include "drivers/io/open_error.h"
#include "drivers/io/replay_stream.h"
#include "drivers/io/tcp_stream.h"
#include "drivers/io/udp_stream.h"
#include "drivers/io/unix_stream.h"

namespace merlin::io {
namespace {

Result<Ok> lockPort(int fd, const std::string& path) {
  if (::flock(fd, LOCK_EX | LOCK_NB) == 0) return Ok{};
  return Error{Errc::kBusy,
               path +
                   ": another device of this configuration, or another program, holds this "
                   "port; name it once, and end that program"};
}

speed_t toSpeed(int baud) {
  switch (baud) {
    case 1200: return B1200;
    case 2400: return B2400;
    case 4800: return B4800;
    case 9600: return B9600;
    case 19200: return B19200;
    case 38400: return B38400;
    case 57600: return B57600;
    case 115200: return B115200;
    default: return B0;
  }
}

Result<std::unique_ptr<ByteStream>> openPty(const std::string& path, int baud) {
  UniqueFd fd(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!fd.valid()) return openError(path, errno);
  if (const auto locked = lockPort(fd.get(), path); !locked) return locked.error();
  termios line{};
  if (::tcgetattr(fd.get(), &line) != 0) {
    return Error{Errc::kIo, path + ": is not a terminal; pty: takes the path of a pseudo-terminal"};
  }
  ::cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  ::cfsetspeed(&line, toSpeed(baud));
  ::tcsetattr(fd.get(), TCSANOW, &line);
  ::tcflush(fd.get(), TCIOFLUSH);
  const int raw = fd.get();
  auto owner = std::make_shared<UniqueFd>(std::move(fd));  // shared: std::function must copy
  return std::unique_ptr<ByteStream>(std::make_unique<FdStream>(raw, [owner] { owner->reset(); }));
}

using PortHandle = std::shared_ptr<sp_port>;  // shared: std::function must copy

Error serialError(const std::string& path, const char* step) {
  const int error = errno;
  if (error == ENOENT || error == EACCES) return openError(path, error);
  char* text = sp_last_error_message();
  Error result{Errc::kIo, fmt::format("{}: {}: {}", path, step, text ? text : "unknown")};
  sp_free_error_message(text);
  return result;
}

Result<std::unique_ptr<ByteStream>> openSerial(const std::string& path, int baud) {
  if (::access(path.c_str(), R_OK | W_OK) != 0) return openError(path, errno);
  sp_port* found = nullptr;
  if (sp_get_port_by_name(path.c_str(), &found) != SP_OK) {
    return Error{Errc::kIo,
                 path + ": is not a serial port (a pseudo-terminal is pty:" + path + ")"};
  }
  const PortHandle port(found, [](sp_port* p) { sp_free_port(p); });
  if (sp_open(found, SP_MODE_READ_WRITE) != SP_OK) return serialError(path, "open");
  const auto close = [port] { sp_close(port.get()); };
  int fd = -1;
  sp_get_port_handle(found, &fd);
  const auto locked = lockPort(fd, path);
  const bool set =
      locked.ok() && sp_set_baudrate(found, baud) == SP_OK && sp_set_bits(found, 8) == SP_OK &&
      sp_set_parity(found, SP_PARITY_NONE) == SP_OK && sp_set_stopbits(found, 1) == SP_OK &&
      sp_set_flowcontrol(found, SP_FLOWCONTROL_NONE) == SP_OK &&
      sp_set_rts(found, SP_RTS_ON) == SP_OK && sp_set_dtr(found, SP_DTR_ON) == SP_OK &&
      sp_flush(found, SP_BUF_BOTH) == SP_OK;
  if (!set) {
    const Error error = locked.ok() ? serialError(path, "line settings") : locked.error();
    close();
    return error;
  }
  askForLowLatency(fd);
  return std::unique_ptr<ByteStream>(std::make_unique<FdStream>(fd, close));
}

// A ReplayStream that owns its SystemClock.
class TimedReplay final : public ByteStream {
 public:
  explicit TimedReplay(Transcript transcript) : stream_(std::move(transcript), clock_) {}
  Result<std::size_t> read(std::span<std::byte> buffer, Duration timeout) override {
    return stream_.read(buffer, timeout);
  }
  Result<std::size_t> write(std::span<const std::byte> bytes, Duration timeout) override {
    return stream_.write(bytes, timeout);
  }
  void interrupt() noexcept override { stream_.interrupt(); }

 private:
  SystemClock clock_;
  ReplayStream stream_;
};

Result<std::unique_ptr<ByteStream>> openReplay(const std::string& path) {
  auto transcript = readTranscript(path);
  if (!transcript) return transcript.error();
  return std::unique_ptr<ByteStream>(std::make_unique<TimedReplay>(*std::move(transcript)));
}

}  // namespace

Result<std::unique_ptr<ByteStream>> openPort(const PortAddress& address, int baud) {
  switch (address.kind) {
    case PortKind::kSerial: return openSerial(address.path, baud);
    case PortKind::kTcp: return openTcp(address.path, address.service);
    case PortKind::kUdp: return openUdp(address.path, address.service);
    case PortKind::kReplay: return openReplay(address.path);
    case PortKind::kUnix: return openUnix(address.path);
    case PortKind::kEvdev: return openEvdev(address.path);
    case PortKind::kPty: break;
  }
  return openPty(address.path, baud);
}

}  // namespace merlin::io
