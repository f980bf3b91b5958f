#include "nn/io/network_file.h"

#include <algorithm>
#include <exception>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/files.h"
#include "daemon/json/json_view.h"

namespace merlin::nn {
namespace {

using nlohmann::json;

constexpr std::uint64_t kVersion = 2;
constexpr std::uint64_t kMostVersions = 1000;
constexpr double kMostWeight = 1e6;    // Phi saturates far below this
constexpr double kLeastSpread = 1e-6;  // least spread of hands, share of a range
constexpr std::size_t kLongestHow = 200;
constexpr auto kMostCount = std::numeric_limits<std::uint64_t>::max();

void readSizes(JsonView sizes) {
  sizes.allowKeys({"inputs", "hidden", "outputs"});
  sizes.at("inputs").count(kInputs, kInputs);
  sizes.at("hidden").count(kHidden, kHidden);
  sizes.at("outputs").count(kOutputs, kOutputs);
}

Phi readPhi(JsonView view) {
  const auto phi = phiNamed(view.text(kLongestName));
  if (!phi) view.addFault("\"sigmoid\", \"signum\" or \"atan\"");
  return phi.value_or(Phi::kSigmoid);
}

InputUnit readUnit(JsonView view) {
  const std::string unit = view.text(kLongestName);
  if (unit != "rad" && unit != "raw") view.addFault("\"rad\" or \"raw\"");
  return unit == "raw" ? InputUnit::kRaw : InputUnit::kRadians;
}

// Reads the ranges of the inputs. Checks that slots and names agree, which detects files that were
// made for another order of the slots.
void readInputs(JsonView inputs, InputUnit unit, InputRanges& ranges) {
  const double most = mostValue(unit);
  inputs.expectArray(kInputs, kInputs);
  for (std::size_t i = 0; i < kInputs; ++i) {
    JsonView input = inputs.at(i);
    input.allowKeys({"slot", "name", "low", "high"});
    input.at("slot").count(i, i);
    JsonView name = input.at("name");
    if (name.text(kLongestHow) != kInputNames[i])
      name.addFault(fmt::format("\"{}\"", kInputNames[i]));
    ranges[i].low = static_cast<float>(input.at("low").number(-most, most));
    JsonView high = input.at("high");
    ranges[i].high = static_cast<float>(high.number(-most, most));
    if (!(ranges[i].low < ranges[i].high)) {
      high.addFault(fmt::format("more than low, {}", ranges[i].low));
    }
  }
}

template <typename Rows>
void readRows(JsonView view, Rows& rows) {
  view.expectArray(rows.size(), rows.size());
  for (std::size_t j = 0; j < rows.size(); ++j) {
    JsonView row = view.at(j);
    row.expectArray(rows[j].size(), rows[j].size());
    for (std::size_t i = 0; i < rows[j].size(); ++i) {
      rows[j][i] = static_cast<float>(row.at(i).number(-kMostWeight, kMostWeight));
    }
  }
}

void readPostures(JsonView list, PostureTable& postures) {
  const std::size_t size = list.expectArray(1, kCodes);
  for (std::size_t n = 0; n < size; ++n) {
    JsonView posture = list.at(n);
    posture.allowKeys({"code", "name"});
    JsonView digits = posture.at("code");
    const auto code = parseCode(digits.text(kLongestHow));
    if (!code) digits.addFault("five digits 0 or 1, output 4 first");
    const auto added = postures.add(code.value_or(0), posture.at("name").text(kLongestHow));
    if (!added) posture.addFault("one code a name, one name a code", added.error().what);
  }
}

// Returns the statistics; nothing if the file's "memory" is empty. Its rows are in the order of the
// postures' codes.
std::optional<PostureStatistics> readStatistics(JsonView view, const PostureTable& postures) {
  view.allowKeys({"mean", "spread"});
  PostureStatistics statistics;
  for (std::uint32_t code = 0; code < kCodes; ++code) {
    if (const auto name = postures.name(code); !name.empty())
      statistics.postures.emplace_back(name);
  }
  JsonView mean = view.at("mean"), spread = view.at("spread");
  const bool any = mean.expectArray(0, kCodes) > 0;
  statistics.mean.resize(any ? statistics.postures.size() : 0);
  if (!any) {
    spread.expectArray(0, 0);
    return std::nullopt;
  }
  readRows(mean, statistics.mean);
  readRows(spread, statistics.spread);
  for (std::size_t i = 0; i < kInputs; ++i) spread.at(i).at(i).number(kLeastSpread, kMostWeight);
  return statistics;
}

Provenance readProvenance(JsonView view) {
  view.allowKeys({"how", "seed", "samples", "mse", "synthetic"});
  Provenance trained;
  trained.how = view.at("how").text(kLongestHow);
  trained.seed = view.at("seed").count(0, kMostCount);
  trained.samples = view.at("samples").count(0, kMostCount);
  trained.mse = view.at("mse").number(0, 1);
  trained.synthetic = view.at("synthetic").boolean();
  return trained;
}

NetworkFile readDocument(JsonView root) {
  NetworkFile file;
  JsonView version = root.at("version");
  // The version is checked first, since anything may differ in another version.
  if (version.count(0, kMostVersions) != kVersion) {
    version.addFault(fmt::format("{}, the version that this release of MERLIN reads", kVersion), {},
                     Errc::kUnsupported);
  }
  root.allowKeys({"version", "sizes", "phi", "unit", "inputs", "hidden", "output", "postures",
                  "memory", "trained"});
  readSizes(root.at("sizes"));
  file.network.phi = readPhi(root.at("phi"));
  file.network.unit = readUnit(root.at("unit"));
  readInputs(root.at("inputs"), file.network.unit, file.network.ranges);
  readRows(root.at("hidden"), file.network.weights.hidden);
  readRows(root.at("output"), file.network.weights.output);
  readPostures(root.at("postures"), file.network.postures);
  file.statistics = readStatistics(root.at("memory"), file.network.postures);
  file.trained = readProvenance(root.at("trained"));
  return file;
}

// Returns fmt's shortest form that reads back as the same float; `+ 0` turns -0 into 0.
std::string number(float v) { return fmt::format("{}", v + 0.0F); }

template <typename Rows>
std::string formatRows(const Rows& rows) {
  std::string out;
  for (const auto& row : rows) {
    out += out.empty() ? "    [" : ",\n    [";
    for (std::size_t i = 0; i < row.size(); ++i) out += (i == 0 ? "" : ", ") + number(row[i]);
    out += ']';
  }
  return out;
}

std::string formatInputs(const InputRanges& ranges) {
  std::string out;
  for (std::size_t i = 0; i < kInputs; ++i) {
    out += fmt::format(R"({}    {{"slot": {}, "name": "{}", "low": {}, "high": {}}})",
                       i == 0 ? "" : ",\n", i, kInputNames[i], number(ranges[i].low),
                       number(ranges[i].high));
  }
  return out;
}

std::string formatPostures(const PostureTable& postures) {
  std::string out;
  for (std::uint32_t code = 0; code < kCodes; ++code) {
    const auto name = postures.name(code);
    if (name.empty()) continue;
    out += fmt::format(R"({}    {{"code": "{}", "name": "{}"}})", out.empty() ? "" : ",\n",
                       formatCode(code), name);
  }
  return out;
}

std::string formatStatistics(const std::optional<PostureStatistics>& statistics,
                             const PostureTable& postures) {
  if (!statistics) return R"("mean": [], "spread": [])";
  std::vector<Input> mean;
  for (std::uint32_t code = 0; code < kCodes; ++code) {
    const auto name = postures.name(code);
    const auto at = std::find(statistics->postures.begin(), statistics->postures.end(), name);
    if (!name.empty() && at != statistics->postures.end())
      mean.push_back(statistics->mean[static_cast<std::size_t>(at - statistics->postures.begin())]);
  }
  return fmt::format("\n  \"mean\": [\n{}\n  ],\n  \"spread\": [\n{}\n  ]", formatRows(mean),
                     formatRows(statistics->spread));
}

}  // namespace

Result<NetworkFile> parseNetwork(std::string_view text, const std::string& file) {
  try {
    const auto document = parseJson(text);
    if (!document) return Error{document.error().code, file + ": " + document.error().what};
    std::optional<Error> error;
    NetworkFile read = readDocument(JsonView(&*document, "", file, error));
    if (error) return *std::move(error);
    return read;
  } catch (const std::exception& ex) {  // out of memory
    return Error{Errc::kMalformed, file + ": " + ex.what()};
  }
}

TrainedPostures trainedPostures(const NetworkFile& file) {
  return {file.network, file.statistics.value_or(PostureStatistics{})};
}

Result<NetworkFile> loadNetwork(const std::string& path) {
  const auto file = FileCopy::read(path, kMostJsonBytes + 1);
  if (!file) return file.error();
  return parseNetwork(file->text(), path);
}

std::string formatNetwork(const NetworkFile& file) {
  constexpr auto kReplace = json::error_handler_t::replace;  // `how` may contain invalid UTF-8
  const PostureNetwork& network = file.network;
  const Provenance& trained = file.trained;
  return fmt::format(
      "{{\n  \"version\": {},\n"
      "  \"sizes\": {{\"inputs\": {}, \"hidden\": {}, \"outputs\": {}}},\n"
      "  \"phi\": \"{}\",\n"
      "  \"unit\": \"{}\",\n"
      "  \"inputs\": [\n{}\n  ],\n"
      "  \"hidden\": [\n{}\n  ],\n"
      "  \"output\": [\n{}\n  ],\n"
      "  \"postures\": [\n{}\n  ],\n"
      "  \"memory\": {{{}}},\n"
      "  \"trained\": {{\"how\": {}, \"seed\": {}, \"samples\": {}, \"mse\": {}, "
      "\"synthetic\": {}}}\n}}\n",
      kVersion, kInputs, kHidden, kOutputs, nameOf(network.phi),
      network.unit == InputUnit::kRaw ? "raw" : "rad", formatInputs(network.ranges),
      formatRows(network.weights.hidden), formatRows(network.weights.output),
      formatPostures(network.postures), formatStatistics(file.statistics, network.postures),
      json(trained.how).dump(-1, ' ', false, kReplace), trained.seed, trained.samples, trained.mse,
      trained.synthetic);
}

Result<Ok> saveNetwork(const std::string& path, const NetworkFile& file) {
  const std::string text = formatNetwork(file);
  if (const auto read = parseNetwork(text, path); !read) {
    return Error{Errc::kInvalidArgument, "not written: " + read.error().what};
  }
  return writeFile(path, text);
}

}  // namespace merlin::nn
