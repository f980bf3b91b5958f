// merlin show: shows a content of the configuration, or any file that merlin can convert to a
// content.
#include <cctype>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/signalfd.h>
#include <unistd.h>

#include "daemon/base/clock.h"
#include "daemon/base/fixed_text.h"
#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/roles.h"
#include "daemon/cli/show/content_folder.h"
#include "daemon/cli/show/conversion.h"
#include "daemon/cli/show/watched_child.h"
#include "daemon/cli/stop_signals.h"
#include "daemon/cli/work_folder.h"
#include "daemon/shm/segment.h"

namespace merlin::cli {
namespace {

namespace fs = std::filesystem;

struct ShowFileOptions {
  std::string instance = "merlin";
  MeshImport mesh;  // options of the import; `inputs` is the content or file to show
  ImageImport image;
  double wait_s = 60;

  const std::string& what() const { return mesh.input(); }
  // Returns the name of an option for the import of meshes that was given; empty if none was.
  std::string meshOption() const {
    if (mesh.range.scale) return "--scale";
    if (mesh.outwards) return "--outwards";
    return mesh.texture.empty() ? mesh.range.anyGiven() : "--texture";
  }
};

constexpr Duration kLook = std::chrono::milliseconds(5);

// Returns an error if --panorama was given. For contents that are not converted to a pyramid now,
// because the pyramid states whether its picture is a panorama. `found`: what the content is, for
// the message.
Result<Ok> checkPanorama(const ShowFileOptions& options, const char* found) {
  if (!options.image.panorama) return Ok{};
  return Error{Errc::kInvalidArgument,
               fmt::format("{}: --panorama is only for a picture that is imported now, and this is "
                           "{}; import the picture with: merlin image import --panorama",
                           options.what(), found)};
}

Result<Ok> checkPanorama(const ShowFileOptions& options, FileKind kind) {
  switch (kind) {
    case FileKind::kModel: return checkPanorama(options, "a model");
    case FileKind::kMesh: return checkPanorama(options, "imported as a model");
    case FileKind::kPyramid: return checkPanorama(options, "already a pyramid");
    case FileKind::kPicture:
    case FileKind::kSlides: break;
  }
  return Ok{};
}

// Waits until the wall has finished the request and then has refused it, has shown another frame,
// or is at rest with full detail, after which no frame follows. Returns the wall's content with the
// result of the request; nothing after options.wait_s.
std::optional<shm::WallContent> awaitDone(const ShowFileOptions& options, std::uint32_t request) {
  const auto segment =
      shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(options.instance, "wall"));
  SystemClock clock;
  const Timestamp until = clock.now() + fromSeconds(options.wait_s);
  std::optional<shm::WallContent> done;
  std::optional<std::uint64_t> frame;
  std::int64_t said_ns = 0;
  for (; segment && clock.now() < until; clock.sleepUntil(clock.now() + kLook, {})) {
    const auto content = (*segment)->content.read();
    const auto stats = (*segment)->stats.read();
    if (!content || !stats) continue;
    if (content->finished == request) done = content;
    if (!done) continue;
    if (!frame) {
      frame = stats->frames;
      said_ns = content->updated_ns;
    }
    const bool at_rest = stats->full_detail != 0 && stats->updated_ns > said_ns;
    if (done->refused[0] != '\0' || stats->frames > *frame || at_rest) return done;
  }
  return std::nullopt;
}

// Asks the wall to show the content, and waits until it does. Errors: those of askRole(); kTimeout;
// kMalformed (the wall has refused the content).
Result<Ok> ask(const ShowFileOptions& options, const RoleRequest& request) {
  const auto asked = askRole(options.instance, "wall", request);
  if (!asked) return asked.error();
  const auto answer = nlohmann::json::parse(*asked, nullptr, false);
  const auto done = awaitDone(options, answer.value("request", std::uint32_t{0}));
  if (!done) {
    return Error{Errc::kTimeout,
                 fmt::format("{} is still not shown after {} s; merlin status says what "
                             "the wall does",
                             options.what(), options.wait_s)};
  }
  const std::string refused(textIn(done->refused));
  if (!refused.empty()) return Error{Errc::kMalformed, refused};
  return Ok{};
}

// Prints a note if a test card covers the content. A test card stays when another content is shown,
// so that a person who adjusts projectors is not interrupted.
void noteTestCard(const ShowFileOptions& options) {
  const auto segment =
      shm::SegmentReader<shm::WallSegment>::open(shm::segmentName(options.instance, "wall"));
  const auto idle = segment ? (*segment)->idle.read() : std::nullopt;
  if (idle && idle->testcard != 0)
    printNote("a test card covers it; to remove the card: merlin wall testcard off");
}

// Has the wall show the progress of the import, about once a second. If the wall does not answer,
// the import continues without such notices.
class WallNotices {
 public:
  WallNotices(const ShowFileOptions& options, const Clock& clock)
      : options_(options),
        clock_(clock),
        file_(excerpt(fs::path(options.what()).filename().string())) {}

  void progress(const std::string& title, double share) {
    const Timestamp now = clock_.now();
    if (now - sent_ < std::chrono::seconds(1)) return;
    sent_ = now;
    std::string step = title.empty() ? "reading" : title;
    step[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(step[0])));
    send(title.empty() ? fmt::format("{} {}", step, file_)
                       : fmt::format("{} {}: {:.0f} %", step, file_, 100 * share));
  }
  void done() {
    if (sent_ != Timestamp{}) send("off");
  }
  void failed(const Error& error) {
    if (error.code == Errc::kClosed) return done();
    send(std::string(wholeCharacters(
        oneLine(fmt::format("{} cannot be shown: {}", file_, error.what)).substr(0, kMost))));
  }

 private:
  static constexpr std::size_t kMost = sizeof(shm::WallNotice::text) - 1;
  void send(const std::string& text) const {
    const auto sent = askRole(options_.instance, "wall", {"notice", text, std::chrono::seconds(1)});
    static_cast<void>(sent);
  }

  const ShowFileOptions& options_;
  const Clock& clock_;
  std::string file_;
  Timestamp sent_{};
};

// While this object exists, SIGTERM, SIGINT and SIGHUP make stop() readable, by which the
// conversion ends, instead of ending this process, so that temporary files can be removed.
class HeldStop {
 public:
  HeldStop() {
    ::sigprocmask(SIG_SETMASK, nullptr, &before_);
    stop_ = stopSignals();
  }
  ~HeldStop() { ::sigprocmask(SIG_SETMASK, &before_, nullptr); }
  HeldStop(const HeldStop&) = delete;
  HeldStop& operator=(const HeldStop&) = delete;

  int stop() const noexcept { return stop_.get(); }
  const sigset_t& before() const noexcept { return before_; }
  // Consumes the signal that has ended the conversion.
  void take() const {
    signalfd_siginfo info{};
    [[maybe_unused]] const auto n = ::read(stop_.get(), &info, sizeof info);
  }

 private:
  sigset_t before_{};
  UniqueFd stop_;
};

// Converts the file in a work folder inside the content folder, and then moves the result to the
// content folder as `name`. Errors: those of roomIn(), WorkFolder::make(), convert() and
// handOver(); kClosed (a signal).
Result<Ok> put(const ShowFileOptions& options, const ContentFolder& folder, FileKind kind,
               const std::string& name, WallNotices& notices) {
  const auto room = roomIn(folder);
  if (!room) return room.error();
  // Held before the work folder is made, because a signal would otherwise leave it behind.
  const HeldStop signals;
  const auto work = WorkFolder::make(fs::path(folder.path) / name);
  if (!work) return work.error();
  const Conversion conversion{options.what(), work->path() + "/" + name, kind, *room};
  const auto made = runWatched(
      {[&](const ProgressListener& listener) {
         return convert(conversion, options.mesh, options.image, listener);
       },
       [&](const std::string& title, double share) { notices.progress(title, share); }, *room},
      signals.stop(), signals.before());
  if (!made && made.error().code == Errc::kClosed) signals.take();
  if (!made) return made;
  return handOver(conversion.output, folder, name);
}

// Converts the file and puts the result into the content folder. Returns its name there.
Result<std::string> putFile(const ShowFileOptions& options, const ContentFolder& folder,
                            WallNotices& notices) {
  const auto kind = kindOfFile(options.what(), !options.meshOption().empty());
  if (!kind) return kind.error();
  if (const auto good = checkPanorama(options, *kind); !good) return good.error();
  const auto name = nameInFolder(options.what(), *kind);
  if (!name) return name;
  const auto done = put(options, folder, *kind, *name, notices);
  if (!done) return done.error();
  return name;
}

int showFile(const ShowFileOptions& options) {
  const SystemClock clock;
  const Timestamp began = clock.now();
  const auto folder = contentFolderOf(options.instance);
  if (!folder) return fail(folder.error());
  WallNotices notices(options, clock);
  const auto cannot = [&notices](const Error& error) {
    notices.failed(error);
    return fail(error);
  };
  const bool there = isIn(*folder, options.what());
  if (const auto good = checkPanorama(options, "in the content folder already"); there && !good)
    return fail(good.error());
  const auto name = there ? Result<std::string>(fs::path(options.what()).filename().string())
                          : putFile(options, *folder, notices);
  if (!name) return cannot(name.error());
  const double made_s = toSeconds(clock.now() - began);
  const auto shown = ask(options, {"show_file", *name});
  const std::string put = folder->path + "/" + *name;
  if (!shown) {
    // A file that cannot be shown is removed from the content folder.
    std::error_code error;
    if (!there && shown.error().code != Errc::kTimeout) fs::remove_all(put, error);
    return cannot(shown.error());
  }
  notices.done();
  printOut("{}: shown after {:.1f} s, of which it took {:.1f} s to put {:.1f} MB into {}\n",
           options.what(), toSeconds(clock.now() - began), made_s,
           static_cast<double>(sizeOfAll(put)) / 1e6, folder->path);
  return kExitDone;
}

int showName(const ShowFileOptions& options) {
  const std::string option = options.meshOption();
  if (!option.empty())
    return fail({Errc::kInvalidArgument,
                 fmt::format("{}: {} is for files; a file needs a '/' or an ending in its name",
                             options.what(), option)});
  if (const auto good = checkPanorama(options, "the name of a content"); !good)
    return fail(good.error());
  const auto shown = ask(options, {"show", options.what()});
  if (shown) return kExitDone;
  std::error_code error;
  if (fs::exists(options.what(), error)) {
    printNote(fmt::format("a {0} {1} is here: merlin show ./{1}",
                          fs::is_directory(options.what(), error) ? "folder" : "file",
                          options.what()));
  }
  return fail(shown.error());
}

// Shows a content by name or a file. The argument is a file if it contains a '/', or if it has an
// ending and either exists or was given with an option for imports; otherwise it is the name of a
// content.
int showContent(ShowFileOptions& options) {
  std::vector<std::string>& inputs = options.mesh.inputs;
  if (const auto input = options.mesh.range.takeInput()) inputs.push_back(*input);
  if (inputs.size() != 1)
    return fail({Errc::kInvalidArgument,
                 fmt::format("{} contents are given; one is shown at a time", inputs.size())});
  std::error_code error;
  const bool ending = fs::path(options.what()).has_extension();
  const bool file = options.what().find('/') != std::string::npos ||
                    (ending && fs::exists(options.what(), error)) ||
                    (ending && (options.image.panorama || !options.meshOption().empty()));
  if (options.mesh.memory > 0) options.image.memory = options.mesh.memory;
  const int status = file ? showFile(options) : showName(options);
  if (status == kExitDone) noteTestCard(options);
  return status;
}

}  // namespace

void addShow(Command app, Run& run) {
  const auto options = std::make_shared<ShowFileOptions>();
  Command command = app.subcommand(
      "show",
      "Show a content on the wall: one of the configuration by its name; a file that was shown "
      "before, by its name, as long as it stays in the content folder; or any file that merlin "
      "mesh import or merlin image import reads, with the options of mesh import, or a folder of "
      "pictures as slides. A PGM, a FITS image and a TIFF are pictures unless their header gives "
      "a geometry or such an option is given. The file is read with your rights; the result goes "
      "into merlind's content folder (/wall/shown). The wall shows the progress. Returns when it "
      "is shown.\n"
      "Example: merlin show scan.pgm --geometry orthogonal --angles 60 45 --scale 0.001");
  addInstance(command, options->instance);
  command.option("what", options->mesh.inputs, "Name of a content, a file or a folder")
      .typeName("NAME|FILE");
  command
      .option("--wait", options->wait_s,
              "Longest time to wait until it is shown, once it is imported, in seconds")
      .seconds()
      .showDefault();
  command.flag("--panorama", options->image.panorama,
               "The picture is equirectangular (360 x 180 degrees): it is shown with the viewer "
               "inside");
  addImportOptions(command, options->mesh);
  command.callback([options, &run] { run = [options] { return showContent(*options); }; });
}

}  // namespace merlin::cli
