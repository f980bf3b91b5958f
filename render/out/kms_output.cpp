#include "render/out/kms_output.h"

#include <utility>

#include "render/out/kms/drm_card.h"

namespace merlin::render::out::kms {
namespace {

// Longest time between two signs of life of the thread.
constexpr Duration kStep = std::chrono::milliseconds(500);
constexpr Duration kLongestLook = std::chrono::seconds(2);

class KmsOutput final : public Output {
 public:
  KmsOutput(std::shared_ptr<CardWorker> worker, std::size_t number)
      : worker_(std::move(worker)), number_(number) {}

  std::vector<DrawPlace> beginDrawing() override {
    return worker_->displays().beginDrawing(number_);
  }
  std::string copyReason() const override { return worker_->displays().copyReason(number_); }
  Result<std::optional<Timestamp>> present(const Signal& signal, const FrameInfo& info) override {
    worker_->start();
    const auto pixels = signal.drawn ? std::span<const std::uint8_t>() : signal.pixels;
    return worker_->displays().present(number_, pixels, info.sequence);
  }
  std::optional<std::string> faultNow() const override {
    return worker_->displays().fault(number_);
  }
  bool wantsFrame(Timestamp) const override { return worker_->displays().wantsFrame(number_); }
  bool canReadBack() const override { return true; }
  Result<std::vector<DisplayReading>> readBack() override {
    auto read = worker_->displays().readBack(number_);
    if (!read) return read.error();
    std::vector<DisplayReading> readings;
    for (const Displays::Reading& reading : *read)
      readings.push_back({reading.connector, reading.found, reading.programs});
    return readings;
  }
  void showAgain() override { worker_->displays().showAgain(number_); }
  std::optional<Vblank> vblank() const override {
    const auto blanks = worker_->displays().blanks();
    if (!blanks) return std::nullopt;
    return Vblank{blanks->last, blanks->period};
  }

 private:
  std::shared_ptr<CardWorker> worker_;
  std::size_t number_;
};

}  // namespace

CardWorker::CardWorker(std::string path, KeptFiles& kept_files, ThreadWatch& watch,
                       const Clock& clock)
    : path_(std::move(path)),
      watch_(watch),
      displays_([path = path_, &kept_files] { return openDrmCard(path, kept_files); }, clock) {}

CardWorker::~CardWorker() { thread_.stop(); }

void CardWorker::start() {
  if (std::exchange(started_, true)) return;
  const std::string name = path_.empty() ? "displays" : "displays of " + path_;
  thread_ = WatchedThread(watch_, name, [this](const std::stop_token& stop, Progress& progress) {
    const std::stop_callback wake(stop, [this] { displays_.wake(); });
    while (!stop.stop_requested()) {
      const Progress::Pause pause(progress);  // reading a display's modes may take long
      displays_.step(kStep);
    }
  });
}

void Cards::open() {
  for (const auto& [path, held] : workers_) {
    const auto worker = held.lock();
    if (!worker) continue;
    worker->start();
    worker->displays().awaitFirstLook(kLongestLook);
  }
}

std::unique_ptr<Output> Cards::makeOutput(const KmsSettings& settings, int picture_width,
                                          int picture_height) {
  auto worker = workers_[settings.card].lock();
  if (!worker) {
    worker = std::make_shared<CardWorker>(settings.card, kept_files_, watch_, clock_);
    workers_[settings.card] = worker;
  }
  const std::size_t number = worker->displays().add(settings, picture_width, picture_height);
  return std::make_unique<KmsOutput>(std::move(worker), number);
}

}  // namespace merlin::render::out::kms
