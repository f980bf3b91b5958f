// spoil_display CARD PID CONNECTOR HOW [FILE]: changes the picture of a display without the
// knowledge of the process that uses the card, for the tests in the virtual machine. It works with
// a copy of that process's descriptor, so that the process stays DRM master and is told nothing.
// HOW:
//   off      switches the display's CRTC off
//   black    overwrites the buffer that is shown with zeros
//   foreign  shows a purple buffer instead
//   keep     writes what is shown to FILE
//   put      writes the content of FILE over what is shown
//   half     as put, but for the lower half only
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

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
  std::fprintf(stderr, "spoil_display: %s: %s\n", step.c_str(), std::strerror(errno));
  std::exit(1);
}

// Returns a copy of the descriptor through which the process is the card's DRM master.
int copyFrom(const std::string& card, int pid) {
  const auto process = static_cast<int>(::syscall(SYS_pidfd_open, pid, 0));
  if (process < 0) fail("pidfd_open");
  for (const auto& entry : fs::directory_iterator("/proc/" + std::to_string(pid) + "/fd")) {
    std::error_code ignored;
    if (fs::read_symlink(entry.path(), ignored) != card) continue;
    const int number = std::stoi(entry.path().filename().string());
    const auto copy = static_cast<int>(::syscall(SYS_pidfd_getfd, process, number, 0));
    if (copy >= 0 && drmIsMaster(copy)) return copy;
    ::close(copy);
  }
  errno = ENOENT;
  fail("a descriptor of " + card + " that is DRM master");
}

struct Display {
  std::uint32_t connector = 0, crtc = 0;
};

Display find(int card, const std::string& name) {
  drmModeRes* const resources = drmModeGetResources(card);
  if (!resources) fail("resources");
  for (int i = 0; i < resources->count_connectors; ++i) {
    drmModeConnector* const c = drmModeGetConnectorCurrent(card, resources->connectors[i]);
    if (!c) continue;
    const std::string here = drmModeGetConnectorTypeName(c->connector_type) + std::string("-") +
                             std::to_string(c->connector_type_id);
    drmModeEncoder* const encoder = drmModeGetEncoder(card, c->encoder_id);
    if (here == name && encoder) return {c->connector_id, encoder->crtc_id};
  }
  errno = ENOENT;
  fail("a lit connector " + name);
}

std::span<std::uint8_t> map(int card, std::uint32_t handle, std::size_t size) {
  std::uint64_t offset = 0;
  if (drmModeMapDumbBuffer(card, handle, &offset)) fail("map");
  void* const at =
      ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, card, static_cast<off_t>(offset));
  if (at == MAP_FAILED) fail("mmap");
  return {static_cast<std::uint8_t*>(at), size};
}

// Returns the memory of the buffer that the CRTC shows.
std::span<std::uint8_t> shownBy(int card, std::uint32_t crtc) {
  drmModeCrtc* const found = drmModeGetCrtc(card, crtc);
  if (!found || found->buffer_id == 0) fail("the buffer that is shown");
  drmModeFB2* const buffer = drmModeGetFB2(card, found->buffer_id);
  if (!buffer || buffer->handles[0] == 0) fail("the buffer's handle");
  return map(card, buffer->handles[0], std::size_t{buffer->pitches[0]} * buffer->height);
}

void showPurple(int card, Display display) {
  drmModeCrtc* const crtc = drmModeGetCrtc(card, display.crtc);
  if (!crtc) fail("CRTC");
  drmModeModeInfo& mode = crtc->mode;
  std::uint32_t handle = 0, pitch = 0, buffer = 0;
  std::uint64_t size = 0;
  if (drmModeCreateDumbBuffer(card, mode.hdisplay, mode.vdisplay, 32, 0, &handle, &pitch, &size))
    fail("buffer");
  if (drmModeAddFB(card, mode.hdisplay, mode.vdisplay, 24, 32, pitch, handle, &buffer))
    fail("frame buffer");
  const auto bytes = map(card, handle, size);
  for (std::size_t i = 0; i + 4 <= bytes.size(); i += 4) std::memcpy(&bytes[i], &kPurple, 4);
  if (drmModeSetCrtc(card, display.crtc, buffer, 0, 0, &display.connector, 1, &mode)) fail("mode");
}

void overwrite(std::span<std::uint8_t> shown, const std::string& path, std::size_t from) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
  if (bytes.size() != shown.size()) fail(path);
  std::memcpy(shown.data() + from, bytes.data() + from, shown.size() - from);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5 || argc > 6)
    return std::fprintf(stderr, "usage: spoil_display CARD PID CONNECTOR HOW [FILE]\n"), 2;
  const std::string how = argv[4], path = argc == 6 ? argv[5] : "";
  const int card = copyFrom(argv[1], std::atoi(argv[2]));
  const Display display = find(card, argv[3]);
  if (how == "off") {
    if (drmModeSetCrtc(card, display.crtc, 0, 0, 0, nullptr, 0, nullptr)) fail("off");
    return 0;
  }
  if (how == "foreign") return showPurple(card, display), 0;
  const auto shown = shownBy(card, display.crtc);
  if (how == "black") return std::memset(shown.data(), 0, shown.size()), 0;
  if (how == "put") return overwrite(shown, path, 0), 0;
  if (how == "half") return overwrite(shown, path, shown.size() / 2), 0;
  if (how != "keep") return std::fprintf(stderr, "spoil_display: no way \"%s\"\n", how.c_str()), 2;
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(shown.data()),
             static_cast<std::streamsize>(shown.size()));
  return file.flush().good() ? 0 : 1;
}
