// merlin posture adapt: adapts a posture network to a new person. merlin posture synthesize:
// creates labelled hands of synthetic people for tests.
#include <memory>

#include <fmt/format.h>

#include "daemon/base/clock.h"
#include "daemon/base/files.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/posture/posture.h"
#include "daemon/cli/print.h"
#include "nn/adapt.h"

namespace merlin::cli {
namespace {

struct AdaptOptions {
  std::string network, data, output;
  RecordingForm form;
  std::uint64_t seed = 1998;
};

int adapt(const AdaptOptions& options) {
  if (const auto writable = checkWritable(options.output); !writable) return fail(writable.error());
  auto file = nn::loadNetwork(options.network);
  if (!file) return fail(file.error());
  if (!file->statistics)
    return fail({Errc::kInvalidArgument,
                 options.network + ": has no /memory, the statistics of its training data, "
                                   "which are needed to adapt it: train the network again"});
  const auto recording = readFor(file->network, options.data, options.form);
  if (!recording) return fail(recording.error());
  const SystemClock clock;
  const Timestamp began = clock.now();
  auto adapted = nn::adapt(file->network, *file->statistics, recording->hands, options.seed);
  if (!adapted) return fail(adapted.error());
  const double seconds = toSeconds(clock.now() - began);
  nn::NetworkFile out = *file;
  out.network = adapted->network;
  out.trained.how =
      fmt::format("{}; adapted to {} hands", file->trained.how, recording->hands.size())
          .substr(0, 200);
  if (const auto saved = nn::saveNetwork(options.output, out); !saved) return fail(saved.error());
  printOut(
      "{}: adapted to {} hands in {:.2f} s: {:.2f} % of them right (before: {:.2f} %); of hands "
      "like those of the training data {:.2f} % right (before: {:.2f} %)\n",
      options.output, recording->hands.size(), seconds, 100 * adapted->hands_after,
      100 * adapted->hands_before, 100 * adapted->drawn_after, 100 * adapted->drawn_before);
  return kExitDone;
}

struct SynthesizeOptions {
  SyntheticPeople people;
  std::string output;
};

int synthesizeFile(const SynthesizeOptions& options) {
  if (const auto writable = checkWritable(options.output); !writable) return fail(writable.error());
  const nn::Recording recording = synthesize(options.people);
  if (const auto saved = nn::saveRecording(options.output, recording); !saved)
    return fail(saved.error());
  printOut("{}: {} synthetic hands of {} people\n", options.output, recording.hands.size(),
           options.people.people);
  return kExitDone;
}

}  // namespace

void addPostureAdapt(Command posture, Run& run) {
  const auto options = std::make_shared<AdaptOptions>();
  Command command = posture.subcommand(
      "adapt",
      "Adapt a network to a new person, from a recording in which the person held each posture for "
      "two seconds; the network still recognises the people it was trained on.\nExample: merlin "
      "posture adapt postures.json anna.csv -o "
      "anna.json");
  command.option("net", options->network, "File of the network").required().typeName("NET.json");
  command.option("hands", options->data, "The person's labelled hands, CSV")
      .required()
      .typeName("DATA.csv");
  command.option("-o", options->output, "File of the adapted network")
      .required()
      .typeName("FILE.json");
  command.option("--seed", options->seed, "Seed of all random numbers").showDefault();
  addForm(command, options->form);
  command.callback([options, &run] { run = [options] { return adapt(*options); }; });
}

void addPostureSynthesize(Command posture, Run& run) {
  const auto options = std::make_shared<SynthesizeOptions>();
  Command command = posture.subcommand("synthesize",
                                       "Create labelled hands of synthetic people, for tests; "
                                       "no real person was measured.\nExample: merlin posture "
                                       "synthesize -o hands.csv --people 10 --first 1001");
  command.option("-o", options->output, "The CSV file").required().typeName("FILE.csv");
  SyntheticPeople& people = options->people;
  const auto count = [&](const char* name, std::size_t& value, const char* help, std::size_t most) {
    command.option(name, value, help).range(std::size_t{1}, most).showDefault();
  };
  count("--first", people.first, "Number of the first person; each number is a different person",
        1 << 30);
  count("--people", people.people, "Number of people", 1000);
  count("--takes", people.takes, "Number of times that each person takes each posture", 1000);
  count("--per-take", people.per_take, "Number of samples in each take", 10000);
  count("--postures", people.postures,
        "Number of postures: the first ones of the 31 known postures are used", 31);
  command.option("--seed", people.seed, "Seed of the random numbers for takes and noise")
      .showDefault();
  command.callback([options, &run] { run = [options] { return synthesizeFile(*options); }; });
}

}  // namespace merlin::cli
