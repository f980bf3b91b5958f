// merlin shm dump: every field of the shared memory, as its own table describes it.
#include <atomic>
#include <cmath>
#include <cstring>
#include <memory>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/shm/segment.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

struct DumpOptions {
  std::string instance = "merlin";
  bool json = false;
  double follow_s = 0;
};

template <typename T>
void appendNumbers(Json& list, const std::byte* at, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    T value;
    std::memcpy(&value, at + i * sizeof value, sizeof value);
    if constexpr (std::is_floating_point_v<T>) {
      list.push_back(std::isfinite(value) ? Json(std::stod(fmt::format("{:.6g}", value)))
                                          : Json(nullptr));
    } else {
      list.push_back(value);
    }
  }
}

std::size_t sizeOf(char type) {
  switch (type) {
    case 'q':
    case 'Q':
    case 'd': return 8;
    case 'i':
    case 'I':
    case 'f': return 4;
    case 'h': return 2;
    default: return 1;
  }
}

Json decode(const shm::Field& f, const std::byte* at) {
  Json list = Json::array();
  switch (f.type[0]) {
    case 'q': appendNumbers<std::int64_t>(list, at, f.count); break;
    case 'Q': appendNumbers<std::uint64_t>(list, at, f.count); break;
    case 'i': appendNumbers<std::int32_t>(list, at, f.count); break;
    case 'I': appendNumbers<std::uint32_t>(list, at, f.count); break;
    case 'h': appendNumbers<std::int16_t>(list, at, f.count); break;
    case 'B': appendNumbers<std::uint8_t>(list, at, f.count); break;
    case 'f': appendNumbers<float>(list, at, f.count); break;
    case 'd': appendNumbers<double>(list, at, f.count); break;
    default: {
      const auto* text = reinterpret_cast<const char*>(at);
      return std::string(text, strnlen(text, f.count));
    }
  }
  return f.count == 1 ? list[0] : list;
}

// The field's value, whole; null where it was never written, or is being written each time we look.
Json readField(const SharedMemory& memory, const shm::Field& f) {
  const std::size_t bytes = sizeOf(f.type[0]) * f.count;
  if (f.offset + bytes > memory.size()) return nullptr;
  if (f.slot == 0) return decode(f, memory.data() + f.offset);
  if (f.slot + 8 > memory.size() || f.slot % 8 != 0) return nullptr;
  const auto& sequence =
      *reinterpret_cast<const std::atomic<std::uint64_t>*>(memory.data() + f.slot);
  std::vector<std::byte> copy(bytes);
  for (int i = 0; i < 1000; ++i) {
    const auto before = sequence.load(std::memory_order_acquire);
    if (before == 0) return nullptr;
    std::memcpy(copy.data(), memory.data() + f.offset, bytes);
    std::atomic_thread_fence(std::memory_order_acquire);
    if (before % 2 == 0 && sequence.load(std::memory_order_relaxed) == before)
      return decode(f, copy.data());
  }
  return nullptr;
}

Result<Json> readSegment(const std::string& name) {
  const auto memory = SharedMemory::open(name);
  if (!memory) return memory.error();
  if (const auto checked = shm::checkHeader(*memory, sizeof(shm::Header), name); !checked)
    return checked.error();
  const auto& header = *reinterpret_cast<const shm::Header*>(memory->data());
  Json fields = Json::object();
  for (std::uint32_t i = 0; i < header.field_count; ++i) {
    shm::Field f = header.fields[i];
    f.name[sizeof f.name - 1] = f.unit[sizeof f.unit - 1] = '\0';
    fields[f.name] = {{"value", readField(*memory, f)}, {"unit", f.unit}};
  }
  return fields;
}

int dump(const DumpOptions& options) {
  Json all = Json::object();
  for (const char* what : {"devices", "wall"}) {
    const std::string name = shm::segmentName(options.instance, what);
    auto fields = readSegment(name);
    if (!fields && fields.error().code == Errc::kNotFound) continue;
    if (!fields) return fail(fields.error());
    all[name] = *std::move(fields);
  }
  if (all.empty())
    return fail(
        {Errc::kIo,
         fmt::format(
             "there is no shared memory /{0}-devices or /{0}-wall: no merlind runs as \"{0}\"",
             options.instance)});
  if (options.json) {
    printJsonLine(all);
    return kExitDone;
  }
  for (const auto& [segment, fields] : all.items()) {
    say("{}\n", segment);
    for (const auto& [name, field] : fields.items()) {
      say("  {:28} {} {}\n", name, jsonText(field["value"]), field["unit"].get<std::string>());
    }
  }
  return kExitDone;
}

int dumpRepeatedly(const DumpOptions& options) {
  int status = dump(options);
  while (status == kExitDone && options.follow_s > 0) {
    std::this_thread::sleep_for(std::chrono::duration<double>(options.follow_s));
    status = dump(options);
  }
  return status;
}

}  // namespace

void addShm(Command app, Run& run) {
  const auto options = std::make_shared<DumpOptions>();
  Command shm = app.subcommand("shm", "The shared memory that other programs read.");
  shm.requireSubcommand();
  Command command =
      shm.subcommand("dump", "Every field: name, value, unit.\nExample: merlin shm dump --json");
  addInstance(command, options->instance);
  command.flag("--json", options->json, "One JSON object");
  command.option("--follow", options->follow_s, "Again and again, every so many seconds").seconds();
  command.callback([options, &run] { run = [options] { return dumpRepeatedly(*options); }; });
}

}  // namespace merlin::cli
