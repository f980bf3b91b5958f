// take_display CARD [PID]: a program that takes over the displays, for the tests in the virtual
// machine. It becomes DRM master, paints every connected display in one colour, and keeps the
// displays until SIGTERM. With PID, it first takes DRM master from that process, by a copy of the
// process's descriptor, as logind does when the session changes.
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kPurple = 0x00800080;

[[noreturn]] void fail(const std::string& step) {
  std::fprintf(stderr, "take_display: %s: %s\n", step.c_str(), std::strerror(errno));
  std::exit(1);
}

void takeFrom(const std::string& card, int pid) {
  const auto process = static_cast<int>(::syscall(SYS_pidfd_open, pid, 0));
  if (process < 0) fail("pidfd_open");
  for (const auto& entry : fs::directory_iterator("/proc/" + std::to_string(pid) + "/fd")) {
    std::error_code ignored;
    if (fs::read_symlink(entry.path(), ignored) != card) continue;
    const int number = std::stoi(entry.path().filename().string());
    const auto copy = static_cast<int>(::syscall(SYS_pidfd_getfd, process, number, 0));
    if (copy < 0) fail("pidfd_getfd");
    drmDropMaster(copy);
    ::close(copy);
  }
  ::close(process);
}

void paint(int card, drmModeConnector& connector, std::uint32_t crtc) {
  drmModeModeInfo& mode = connector.modes[0];
  std::uint32_t handle = 0, pitch = 0, buffer = 0;
  std::uint64_t size = 0, offset = 0;
  if (drmModeCreateDumbBuffer(card, mode.hdisplay, mode.vdisplay, 32, 0, &handle, &pitch, &size))
    fail("buffer");
  if (drmModeAddFB(card, mode.hdisplay, mode.vdisplay, 24, 32, pitch, handle, &buffer))
    fail("frame buffer");
  if (drmModeMapDumbBuffer(card, handle, &offset)) fail("map");
  void* const at =
      ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, card, static_cast<off_t>(offset));
  if (at == MAP_FAILED) fail("mmap");
  auto* const pixels = static_cast<std::uint32_t*>(at);
  for (std::uint64_t i = 0; i < size / 4; ++i) pixels[i] = kPurple;
  if (drmModeSetCrtc(card, crtc, buffer, 0, 0, &connector.connector_id, 1, &mode)) fail("mode");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) return std::fprintf(stderr, "usage: take_display CARD [PID]\n"), 2;
  sigset_t end;
  sigemptyset(&end);
  sigaddset(&end, SIGTERM);
  sigprocmask(SIG_BLOCK, &end, nullptr);
  const int card = ::open(argv[1], O_RDWR | O_CLOEXEC);
  if (card < 0) fail(argv[1]);
  if (argc == 3) takeFrom(argv[1], std::atoi(argv[2]));
  if (!drmIsMaster(card) && drmSetMaster(card) != 0) fail("become DRM master");
  drmModeRes* const resources = drmModeGetResources(card);
  if (!resources) fail("resources");
  for (int i = 0; i < resources->count_connectors && i < resources->count_crtcs; ++i) {
    drmModeConnector* const connector = drmModeGetConnector(card, resources->connectors[i]);
    if (connector && connector->connection == DRM_MODE_CONNECTED && connector->count_modes > 0)
      paint(card, *connector, resources->crtcs[i]);
    drmModeFreeConnector(connector);
  }
  drmModeFreeResources(resources);
  std::printf("take_display: has the displays\n");
  std::fflush(stdout);
  int signal = 0;
  sigwait(&end, &signal);
  return 0;
}
