// merlin posture: train the posture network, and test one.
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clock.h"
#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/progress.h"
#include "drivers/hand/shapes.h"
#include "nn/io/data_set_file.h"
#include "nn/io/network_file.h"
#include "nn/shipped.h"

namespace merlin::cli {
namespace {

// The test's hands are none of the training's: another seed.
constexpr std::uint64_t kTestSeed = 2026;
constexpr std::size_t kTestHands = 1000;  // of each shape

struct PostureOptions {
  std::string network = "config/postures.json", output, data;
  std::uint64_t seed = nn::kShippedSeed;
  bool json = false;
};

std::vector<nn::HandShape> shippedShapes() {
  std::vector<nn::HandShape> shapes;
  for (const hand::Shape& shape : hand::shapes()) shapes.push_back({shape.name, shape.angle_rad});
  return shapes;
}

int train(const PostureOptions& options) {
  const SystemClock clock;
  ProgressBar bar("training", "steps", clock);
  const nn::TrainSettings limits;
  std::size_t steps = 0;
  const auto trained =
      nn::trainShipped(shippedShapes(), options.seed, [&](std::size_t step, double) {
        steps = step;
        bar.update(static_cast<double>(step) / static_cast<double>(limits.max_iterations), step);
        return true;
      });
  bar.finish(steps);
  if (!trained) return fail(trained.error());
  const auto saved = nn::saveNetwork(options.output, trained->network, trained->trained);
  if (!saved) return fail(saved.error());
  const nn::TrainReport& r = trained->report;
  fmt::print(
      "{}: {} postures, mean squared error {:.2g} after {} steps, {:.2f} % of the synthetic "
      "training hands right\n",
      options.output, trained->network.postures.size(), r.mse, r.iterations, 100 * r.accuracy);
  return kExitDone;
}

Result<nn::DataSet> testHands(const PostureOptions& options) {
  if (!options.data.empty()) return nn::loadDataSet(options.data);
  nn::SyntheticSettings settings;
  settings.per_shape = kTestHands;
  return nn::makeHands(shippedShapes(), settings, kTestSeed);
}

int test(const PostureOptions& options) {
  const auto file = nn::loadNetwork(options.network);
  if (!file) return fail(file.error());
  const auto hands = testHands(options);
  if (!hands) return fail(hands.error());
  if (hands->empty()) return fail({Errc::kMalformed, options.data + ": has no hands"});
  const nn::Score score = nn::score(file->network, *hands);
  const bool synthetic = options.data.empty();
  if (options.json) {
    const nlohmann::ordered_json json = {{"accuracy", score.accuracy()},
                                         {"right", score.right},
                                         {"total", score.total},
                                         {"rejected", score.rejected},
                                         {"synthetic", synthetic}};
    fmt::print("{}\n", json.dump());
  } else {
    fmt::print("{} of {} {} right ({:.3f} %), {} taken for no posture, {} for another\n",
               score.right, score.total, synthetic ? "held-out synthetic hands" : "hands",
               100 * score.accuracy(), score.rejected, score.total - score.right - score.rejected);
  }
  return kExitDone;
}

}  // namespace

void addPosture(CLI::App& app, Run& run) {
  const auto options = std::make_shared<PostureOptions>();
  CLI::App* posture = app.add_subcommand("posture", "The posture network: train one, test one.");
  posture->require_subcommand(1);
  CLI::App* train_command =
      posture->add_subcommand("train",
                              "Train on synthetic hands of the shipped shapes.\nExample: merlin "
                              "posture train -o postures.json");
  train_command->add_option("-o", options->output, "The network's file")
      ->required()
      ->type_name("FILE.json");
  train_command->add_option("--seed", options->seed, "Of hands and first weights")
      ->capture_default_str();
  train_command->callback([options, &run] { run = [options] { return train(*options); }; });
  CLI::App* test_command = posture->add_subcommand(
      "test",
      "How many hands a network names right: held-out synthetic ones, or a CSV file's.\nExample: "
      "merlin posture test --network config/postures.json --json");
  test_command->add_option("--network", options->network, "The network's file")
      ->capture_default_str()
      ->type_name("FILE.json");
  test_command->add_option("--data", options->data, "Labelled hands: posture,s0..s22 in radians")
      ->type_name("FILE.csv");
  test_command->add_flag("--json", options->json, "For programs");
  test_command->callback([options, &run] { run = [options] { return test(*options); }; });
}

}  // namespace merlin::cli
