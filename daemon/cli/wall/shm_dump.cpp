// merlin shm dump: prints every field of the shared memory, using the table of fields that it
// contains.
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/fixed_text.h"
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
Json number(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  if constexpr (std::is_floating_point_v<T>) {
    return std::isfinite(value) ? Json(std::stod(fmt::format("{:.6g}", value))) : Json(nullptr);
  } else {
    return value;
  }
}

// Returns the size of one value of the field [bytes]; 0 for an unknown type. Types are format
// characters of Python's struct module; "20s" is a text of 20 bytes.
std::size_t sizeOf(const shm::Field& f) {
  const std::string_view type = textIn(f.type);
  if (type.ends_with('s')) return static_cast<std::size_t>(std::atoi(f.type));
  if (type.size() != 1) return 0;
  switch (type[0]) {
    case 'q':
    case 'Q':
    case 'd': return 8;
    case 'i':
    case 'I':
    case 'f': return 4;
    case 'h':
    case 'H': return 2;
    case 'B': return 1;
    default: return 0;
  }
}

Json decodeOne(const shm::Field& f, const std::byte* at) {
  switch (f.type[0]) {
    case 'q': return number<std::int64_t>(at);
    case 'Q': return number<std::uint64_t>(at);
    case 'i': return number<std::int32_t>(at);
    case 'I': return number<std::uint32_t>(at);
    case 'h': return number<std::int16_t>(at);
    case 'H': return number<std::uint16_t>(at);
    case 'B': return number<std::uint8_t>(at);
    case 'f': return number<float>(at);
    case 'd': return number<double>(at);
    default: {
      const auto* text = reinterpret_cast<const char*>(at);
      return std::string(text, strnlen(text, sizeOf(f)));
    }
  }
}

// Converts the values of the field to JSON: a list if there are several. `values`: the first byte
// of the field.
Json decode(const shm::Field& f, const std::byte* values) {
  if (f.count == 1) return decodeOne(f, values);
  Json list = Json::array();
  for (std::uint32_t i = 0; i < f.count; ++i)
    list.push_back(decodeOne(f, values + std::size_t{i} * f.step));
  return list;
}

// Returns a consistent copy of the field's value; null if the value was never written, if each
// attempt to read it coincided with a write, or if the table's entry is invalid.
Json readField(const SharedMemory& memory, const shm::Field& f) {
  const std::size_t one = sizeOf(f);
  if (one == 0 || f.count == 0 || f.step < one) return nullptr;
  const std::size_t bytes = (f.count - std::size_t{1}) * f.step + one;
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
    shm::Field f;
    std::memcpy(&f, memory->data() + header.field_offset + std::size_t{i} * header.field_size,
                sizeof f);
    f.name[sizeof f.name - 1] = f.unit[sizeof f.unit - 1] = f.type[sizeof f.type - 1] = '\0';
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
    printOut("{}\n", segment);
    for (const auto& [name, field] : fields.items()) {
      printOut("  {:28} {} {}\n", name, jsonText(field["value"]), field["unit"].get<std::string>());
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
  Command shm =
      app.subcommand("shm", "Print merlind's shared memory, which other programs can read too.");
  shm.requireSubcommand();
  Command command = shm.subcommand(
      "dump", "Print every field: name, value, unit.\nExample: merlin shm dump --json");
  addInstance(command, options->instance);
  command.flag("--json", options->json, "Print one JSON object, for programs");
  command.option("--follow", options->follow_s, "Repeat, with this interval in seconds").seconds();
  command.callback([options, &run] { run = [options] { return dumpRepeatedly(*options); }; });
}

}  // namespace merlin::cli
