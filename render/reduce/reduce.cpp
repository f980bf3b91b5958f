#include "render/reduce/reduce.h"

#include <array>
#include <cassert>

#include <fmt/format.h>

#include "render/reduce/costs.h"
#include "render/reduce/memory.h"

namespace merlin::render::reduce {
namespace {

constexpr std::array kCosts = {
    Cost{"quadric", "distance from the surface and its features; lowest error", quadricWeights,
         reduceByQuadric},
    Cost{"pattern", "length of the edge in pattern space, as in Gourley's dissertation of 1998",
         defaultWeights, reduceByPattern},
};

Result<Ok> check(const ReduceSettings& s) {
  if (!findCost(s.cost)) {
    std::string known;
    for (const Cost& cost : kCosts)
      known += fmt::format("{}{}", known.empty() ? "" : ", ", cost.name);
    return Error{Errc::kInvalidArgument, fmt::format("cost {}: is not one of {}", s.cost, known)};
  }
  if (s.fast && s.cost != "quadric")
    return Error{Errc::kInvalidArgument,
                 fmt::format("cost {}: only the cost quadric has a fast mode", s.cost)};
  if (!(s.min_percent >= 0 && s.min_percent <= 100)) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("percent {} is not from 0 to 100", s.min_percent)};
  }
  if (!(s.max_error_percent >= 0)) {
    return Error{Errc::kInvalidArgument,
                 fmt::format("error {} % is not 0 or more", s.max_error_percent)};
  }
  return Ok{};
}

}  // namespace

std::span<const Cost> costs() { return kCosts; }

const Cost* findCost(std::string_view name) {
  for (const Cost& cost : kCosts) {
    if (name == cost.name) return &cost;
  }
  return nullptr;
}

Weights weightsFor(const mesh::Mesh& mesh, const ReduceSettings& settings) {
  return settings.weights.empty() ? findCost(settings.cost)->weights(mesh) : settings.weights;
}

std::string aboutText(const ReduceSettings& settings, const Weights& weights,
                      const ReduceReport& report) {
  std::string text =
      fmt::format("cost={}\nfast={}\npreserve_topology={}\nstopped={}\n", settings.cost,
                  settings.fast, settings.preserve_topology, report.stopped);
  for (const auto& [name, weight] : weights) text += fmt::format("weight.{}={}\n", name, weight);
  return text;
}

Result<Reduction> reduce(const mesh::Mesh& mesh, const ReduceSettings& settings,
                         const Progress& progress) {
  assert(mesh.find("normal") && mesh.find("normal")->dimension == 3);
  if (const auto checked = check(settings); !checked) return checked.error();
  if (const auto fits = blocksFor(mesh::sizeOf(mesh), settings); !fits) return fits.error();
  return findCost(settings.cost)->reduce(mesh, settings, progress);
}

}  // namespace merlin::render::reduce
