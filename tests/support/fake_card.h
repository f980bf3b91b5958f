// FakeCard: a graphics card with two displays, which records what it is told to show.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "render/out/kms/card.h"

namespace merlin::test {

using render::out::digestOf;
using render::out::PictureDigest;
using render::out::PixelOrder;
using render::out::kms::Buffer;
using render::out::kms::Card;
using render::out::kms::CardContents;
using render::out::kms::CommitResult;
using render::out::kms::Committed;
using render::out::kms::Connector;
using render::out::kms::Flip;
using render::out::kms::Id;
using render::out::kms::Lit;
using render::out::kms::Mode;
using render::out::kms::ScannedOut;
using render::out::kms::Scanout;

inline Mode mode(int width, int height, double hz, bool preferred = false) {
  return {width, height, hz, preferred, false, 0};
}

inline Connector projector(Id id, const std::string& name) {
  return {.id = id,
          .name = name,
          .connected = true,
          .modes = {mode(1024, 768, 60, true), mode(640, 480, 60), mode(640, 480, 59.94),
                    mode(640, 480, 75)},
          .crtcs = 0b11};
}

// The state of the fake card, which tests read and change. It outlives the card, since every call
// of open() makes a new card.
struct Bench {
  std::vector<Connector> connectors{projector(11, "A-1"), projector(12, "A-2")};
  bool there = true, other_is_master = false, has_vblank = false, answers_flips = true;
  int probes = 0, cards = 0, most_alive = 0;
  std::set<Id> refused;               // connectors that the card refuses
  std::size_t most_at_once = 9;       // displays that the card can light at once
  Committed next = Committed::kDone;  // outcome of the next commit, except for test commits
  std::vector<std::vector<Lit>> commits;
  std::vector<Flip> flips;
  std::map<Id, std::vector<std::uint8_t>*> buffers;
  bool shares = false;  // whether buffers that are made from now on share their memory
  std::map<const DmaBuf*, Id> buffer_of;  // buffer for each shared memory
  Timestamp flip_time{};

  // For each CRTC, the first byte (blue) of the pixel in the middle of the picture that it shows.
  std::map<Id, int> shown;
  std::map<Id, ScannedOut> scanned;  // for each CRTC, what the kernel would report
  std::function<void()> on_read;     // called each time a buffer is read
};

struct FakeBuffer final : Buffer {
  FakeBuffer(Bench& b, Id number, int width, int height)
      : bench(b),
        n(number),
        row(static_cast<std::size_t>(width) * 4),
        data(row * static_cast<std::size_t>(height)) {
    bench.buffers[n] = &data;
    if (!bench.shares) return;
    auto memory = std::make_shared<DmaBuf>();
    memory->width = width;
    memory->height = height;
    memory->pitch = static_cast<std::uint32_t>(row);
    lent = std::move(memory);
    bench.buffer_of[lent.get()] = n;
  }
  ~FakeBuffer() override {
    bench.buffers.erase(n);
    bench.buffer_of.erase(lent.get());
  }
  Id id() const override { return n; }
  std::span<std::uint8_t> bytes() override { return data; }
  std::size_t pitch() const override { return row; }
  std::shared_ptr<const DmaBuf> shared() const override { return lent; }
  Bench& bench;
  Id n;
  std::size_t row;
  std::vector<std::uint8_t> data;
  std::shared_ptr<const DmaBuf> lent{};
};

struct FakeScanout final : Scanout {
  explicit FakeScanout(Bench& b) : bench(b) {}
  Result<ScannedOut> look(Id crtc, Id) override {
    if (!bench.there) return Error{Errc::kIo, "the card has gone"};
    return bench.scanned[crtc];
  }
  // Reads only buffers of 640 x 480 pixels.
  Result<PictureDigest> read(Id buffer, int width, int height) override {
    const PictureDigest digest =
        digestOf({width, height, *bench.buffers.at(buffer), 640 * 4, PixelOrder::kBgrx});
    if (bench.on_read) bench.on_read();
    return digest;
  }
  std::vector<std::string> others() const override { return {"desktop (77)"}; }
  Bench& bench;
};

struct FakeCard final : Card {
  explicit FakeCard(Bench& b) : bench(b) {}
  const std::string& path() const override { return name; }
  Result<CardContents> look(bool probe) override {
    bench.probes += probe ? 1 : 0;
    if (!bench.there) return Error{Errc::kIo, "the card has gone"};
    return CardContents{bench.connectors, {21, 22}, {31, 32}};
  }
  Result<std::shared_ptr<Buffer>> makeBuffer(int width, int height) override {
    static Id next = 100;
    return std::shared_ptr<Buffer>(std::make_shared<FakeBuffer>(bench, ++next, width, height));
  }
  bool becomeMaster() override { return master = !bench.other_is_master; }
  bool isMaster() const override { return master && !bench.other_is_master; }
  std::vector<std::string> others() const override { return {"desktop (77)"}; }
  CommitResult commit(std::span<const Lit> lit, bool test_only) override {
    if (!bench.there) return {Committed::kGone, "the card has gone"};
    if (bench.other_is_master) return {Committed::kNotMaster};
    const auto refuses = [&](const Lit& l) { return bench.refused.count(l.connector) > 0; };
    if (std::ranges::any_of(lit, refuses) || lit.size() > bench.most_at_once)
      return {Committed::kRefused, "Invalid argument"};
    if (test_only) return {};
    if (bench.next != Committed::kDone) return {std::exchange(bench.next, Committed::kDone)};
    bench.commits.emplace_back(lit.begin(), lit.end());
    for (const Lit& l : lit) {
      const auto& data = *bench.buffers.at(l.buffer);
      bench.scanned[l.crtc] = {true, false, l.buffer};
      bench.shown[l.crtc] = data[data.size() / 2];
      if (bench.answers_flips) bench.flips.push_back({l.crtc, bench.flip_time});
    }
    return {};
  }
  std::vector<Flip> wait(Duration) override { return std::exchange(bench.flips, {}); }
  void wake() override {}
  std::shared_ptr<Scanout> scanout() override { return std::make_shared<FakeScanout>(bench); }
  bool hasVblank(Id) const override { return bench.has_vblank; }
  Bench& bench;
  std::string name = "/dev/dri/card7";
  bool master = false;
};

}  // namespace merlin::test
