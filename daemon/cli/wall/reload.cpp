// merlin reload: has merlind read its configuration again and put the changes into effect.
#include "daemon/cli/wall/reload.h"

#include <algorithm>
#include <memory>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clock.h"
#include "daemon/cli/command.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/roles.h"
#include "daemon/reload/plan.h"
#include "daemon/state/set_aside.h"

namespace merlin::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr Duration kReloadPollPeriod = std::chrono::milliseconds(20);
// Long, because a file system may be slow.
constexpr Duration kReloadPatience = std::chrono::seconds(60);

struct ReloadOptions {
  std::string instance = "merlin";
  std::uint32_t pid = 0;
  bool check = false, json = false;
};

// The result of a request in one process; `answer` has the format of daemon/reload/answer.h.
struct Reloaded {
  FoundRole process;
  Json answer;
  std::string outcome() const { return answer.value("outcome", ""); }
  bool restarts() const { return outcome() == "restarts"; }
  bool done() const { return outcome() == "done" || restarts(); }
};

// Returns one role of each process, because a process with both roles reads its configuration only
// once.
std::vector<FoundRole> processesOf(std::vector<FoundRole> roles) {
  std::set<std::uint32_t> seen;
  std::erase_if(roles, [&](const FoundRole& role) { return !seen.insert(role.pid).second; });
  return roles;
}

reload::Readers readersOf(const std::vector<FoundRole>& roles) {
  reload::Readers readers = 0;
  for (const FoundRole& role : roles)
    readers |= role.role == "wall" ? reload::kWall : reload::kDevices;
  return readers;
}

// Has a process read its configuration, and waits for the result. `what`: "now", or "check" for a
// check without changes. Errors: those of askRole(); kTimeout.
Result<Reloaded> reloadProcess(const std::string& instance, const FoundRole& process,
                               const char* what) {
  const auto ask = [&](const std::string& argument) -> Result<Json> {
    const auto text = askRole(instance, process.role, {"reload", argument});
    if (!text) return text.error();
    return Json::parse(*text, nullptr, false);
  };
  const auto begun = ask(what);
  if (!begun) return begun.error();
  const std::string number = std::to_string(begun->value("request", 0U));
  SystemClock clock;
  for (const Timestamp until = clock.now() + kReloadPatience; clock.now() < until;) {
    auto answer = ask(number);
    if (!answer) return answer.error();
    if (!answer->value("pending", false)) return Reloaded{process, *std::move(answer)};
    clock.sleepUntil(clock.now() + kReloadPollPeriod, {});
  }
  return Error{Errc::kTimeout,
               fmt::format("merlind (process {}) has not read its configuration within {:.0f} s; "
                           "its log will say what became of it",
                           process.pid, toSeconds(kReloadPatience))};
}

Result<std::vector<Reloaded>> reloadEach(const std::string& instance,
                                         const std::vector<FoundRole>& processes,
                                         const char* what) {
  std::vector<Reloaded> all;
  for (const FoundRole& process : processes) {
    auto reloaded = reloadProcess(instance, process, what);
    if (!reloaded) return reloaded.error();
    all.push_back(*std::move(reloaded));
  }
  return all;
}

bool allDone(const std::vector<Reloaded>& all) {
  return std::ranges::all_of(all, [](const Reloaded& r) { return r.done(); });
}

// Reloads or checks the configuration of all processes. A reload is atomic only within one process;
// with several processes, therefore, all check the file before the first one changes anything.
Result<std::vector<Reloaded>> reloadAll(const ReloadOptions& options,
                                        const std::vector<FoundRole>& processes) {
  if (options.check || processes.size() > 1) {
    auto checked = reloadEach(options.instance, processes, "check");
    if (options.check || !checked || !allDone(*checked)) return checked;
  }
  return reloadEach(options.instance, processes, "now");
}

// Returns whether the role answers and, if it is a wall, has drawn a frame.
bool works(const std::string& instance, const std::string& role) {
  const auto answer = askRole(instance, role, {"status"});
  const Json status = answer ? Json::parse(*answer, nullptr, false) : Json();
  return status.is_object() && status.value("frames", 1) > 0;
}

bool isBack(const std::string& instance, const FoundRole& before) {
  const auto roles = findRoles(instance);
  if (!roles) return false;
  return std::ranges::any_of(*roles, [&](const FoundRole& now) {
    return now.role == before.role && now.generation != before.generation &&
           works(instance, now.role);
  });
}

// Waits until each process that restarts works again. Errors: kTimeout.
Result<Ok> awaitStarts(const std::string& instance, const std::vector<Reloaded>& all) {
  SystemClock clock;
  const Timestamp until = clock.now() + kReloadPatience;
  for (const Reloaded& reloaded : all) {
    while (reloaded.restarts() && !isBack(instance, reloaded.process)) {
      if (clock.now() > until) {
        return Error{Errc::kTimeout,
                     fmt::format("merlind (process {}) has not started again within {:.0f} s; its "
                                 "log will say what became of it",
                                 reloaded.process.pid, toSeconds(kReloadPatience))};
      }
      clock.sleepUntil(clock.now() + kReloadPollPeriod, {});
    }
  }
  return Ok{};
}

std::string changeText(const Json& change) {
  const std::string from = change.value("from", ""), to = change.value("to", "");
  const std::string setting = change.value("setting", "");
  if (from.empty()) return fmt::format("{}: {} (new)", setting, to);
  if (to.empty()) return fmt::format("{}: {} -> removed", setting, from);
  return fmt::format("{}: {} -> {}", setting, from, to);
}

// Returns the texts of the entries `key` in all answers, each text once, in the order of the
// processes. `text` converts an entry to a text.
std::vector<std::string> together(const std::vector<Reloaded>& all, const char* key,
                                  std::string (*text)(const Json&)) {
  std::vector<std::string> texts;
  for (const Reloaded& reloaded : all) {
    for (const Json& entry : reloaded.answer.value(key, Json::array())) {
      std::string one = text(entry);
      if (std::ranges::find(texts, one) == texts.end()) texts.push_back(std::move(one));
    }
  }
  return texts;
}

std::string itself(const Json& json) { return json.is_string() ? json.get<std::string>() : ""; }

// Returns the note about an alignment that does not fit its output any more. `is`: "is" or "would
// be".
std::string asideText(const Json& aside, const char* is) {
  return fmt::format("the alignment of output {} {} set aside: {}; {}", aside.value("output", ""),
                     is, aside.value("why", ""), state::kComesBack);
}

// Removes the settings whose list or group is in `settings` too, because all of that list or group
// has changed.
void leaveOutMembers(std::vector<std::string>& settings) {
  const std::vector<std::string> whole = settings;
  std::erase_if(settings, [&](const std::string& setting) {
    return std::ranges::any_of(
        whole, [&](const std::string& group) { return setting.starts_with(group + "/"); });
  });
}

// Returns the changed settings that make a restart necessary.
std::vector<std::string> restartSettings(const std::vector<Reloaded>& all) {
  std::vector<std::string> settings = together(all, "restart", itself);
  leaveOutMembers(settings);
  return settings;
}

// Returns the changed settings that each process reports as read by others, but that no running
// process reads.
std::vector<std::string> readByNone(const std::vector<Reloaded>& all, reload::Readers running) {
  std::vector<std::string> settings = together(all, "elsewhere", itself);
  std::erase_if(settings, [&](const std::string& setting) {
    return (reload::takerOf(setting).readers & running) != 0;
  });
  leaveOutMembers(settings);
  return settings;
}

const char* whoTakes(reload::Readers readers) {
  if (readers == reload::kPage) return "is read by the page: systemctl reload merlin-page";
  if (readers == reload::kAlarms) return "is read by the alarms: systemctl reload merlin-alarms";
  return "is taken by a merlind of another role when it starts";
}

// Consecutive settings of one group or list entry, with the text that is printed after them.
struct SettingsTogether {
  std::string group;               // "/alarms/0"
  std::vector<std::string> names;  // "run", "kinds"
  std::string said;

  std::string text() const {
    if (names.size() == 1) return fmt::format("{}/{}{}", group, names.front(), said);
    return fmt::format("{} ({}){}", group, fmt::join(names, ", "), said);
  }
};

// Prints one line for each group or list entry, however many of its settings changed. `before`:
// beginning of each line; `said`: returns the text after a setting.
void printTogether(const char* before, const std::vector<std::string>& settings,
                   std::string (*said)(const std::string&)) {
  std::vector<SettingsTogether> lines;
  for (const std::string& setting : settings) {
    const std::size_t slash = setting.rfind('/');
    const std::string group = setting.substr(0, slash), what = said(setting);
    if (lines.empty() || group.empty() || lines.back().group != group || lines.back().said != what)
      lines.push_back({group, {}, what});
    lines.back().names.push_back(setting.substr(slash + 1));
  }
  for (const SettingsTogether& line : lines) printOut("{}{}\n", before, line.text());
}

// Prints the changes, for a request that no process refused. `tense`: "started", "starts" or "would
// start", for the sentence about a restart.
void printDone(const std::vector<Reloaded>& all, reload::Readers running, const char* tense) {
  const auto swapped = together(all, "swapped", changeText);
  const auto unread = readByNone(all, running);
  for (const std::string& line : swapped) printOut("{}\n", line);
  printTogether("", unread, [](const std::string& setting) {
    return fmt::format(": {}", whoTakes(reload::takerOf(setting).readers));
  });
  const auto restart = restartSettings(all);
  if (!restart.empty())
    printOut("merlind {} again, because these settings take effect only at a start:\n", tense);
  printTogether("  ", restart, [](const std::string&) { return std::string(); });
  if (swapped.empty() && unread.empty() && restart.empty()) printOut("nothing changed\n");
  const bool is_check = std::ranges::any_of(
      all, [](const Reloaded& r) { return r.answer.value("only_checked", false); });
  const auto aside = together(
      all, "set_aside",
      is_check ? +[](const Json& a) { return asideText(a, "would be"); }
               : +[](const Json& a) { return asideText(a, "is"); });
  for (const std::string& note : aside) printNote(note);
  for (const std::string& output : together(all, "brought_back", itself)) {
    printNote(fmt::format("the alignment of output {}, which was set aside, {} in effect again",
                          output, is_check ? "would be" : "is"));
  }
}

// Prints why nothing was changed.
void printRefusal(const std::vector<Reloaded>& all) {
  for (const Reloaded& reloaded : all) {
    const std::string file = reloaded.answer.value("file", ""), outcome = reloaded.outcome();
    if (outcome == "invalid") {
      const std::size_t findings = reloaded.answer.value("findings", Json::array()).size();
      printError("merlin: {}: invalid, {} finding{}; nothing was changed\n", printable(file),
                 findings, findings == 1 ? "" : "s");
      return;
    }
    if (!reloaded.done()) {
      printError("merlin: {}: {}; nothing was changed\n", printable(file),
                 printable(reloaded.answer.value("failure", "no reason")));
      return;
    }
  }
}

// Prints the findings as `merlind --check-config` does, including numbers that were adjusted, then
// the result.
void print(const std::vector<Reloaded>& all, reload::Readers running, const char* tense) {
  for (const std::string& finding : together(all, "findings", itself))
    printError("{}\n", printable(finding));
  allDone(all) ? printDone(all, running, tense) : printRefusal(all);
}

int exitStatusOf(const std::vector<Reloaded>& all) {
  if (allDone(all)) return kExitDone;
  const bool invalid =
      std::ranges::any_of(all, [](const Reloaded& r) { return r.outcome() == "invalid"; });
  return invalid ? kExitBadInput : kExitFailed;
}

// Returns whether the instance name changes with the restart, so that the process cannot be found
// under its old name.
bool renames(const std::vector<Reloaded>& all) {
  const auto restart = restartSettings(all);
  return std::ranges::find(restart, "/instance") != restart.end();
}

// Asks the processes of the instance once. `roles` is set to the roles of these processes, as far
// as they are known.
Result<std::vector<Reloaded>> askOnce(ReloadOptions& options, std::vector<FoundRole>& roles) {
  roles.clear();
  if (options.pid > 0) {
    roles.push_back({.role = "", .endpoints = {}, .pid = options.pid});
    auto instance = instanceOf(options.pid);
    if (!instance) return instance.error();
    options.instance = *std::move(instance);
  }
  auto found = findRoles(options.instance);
  if (!found) return found.error();
  roles = *std::move(found);
  return reloadAll(options, processesOf(roles));
}

// Returns whether the process of this role is restarting or has just restarted, so that it could
// not answer.
bool startsAgain(const std::string& instance, const FoundRole& before) {
  const auto roles = findRoles(instance);
  const bool is_same = roles && std::ranges::any_of(*roles, [&](const FoundRole& now) {
                         return now.pid == before.pid && now.generation == before.generation;
                       });
  return !is_same && isMerlind(before.pid);
}

// Asks all processes, and asks again while one of them is restarting, which another request may
// have caused.
Result<std::vector<Reloaded>> ask(ReloadOptions& options, std::vector<FoundRole>& roles) {
  SystemClock clock;
  for (const Timestamp until = clock.now() + kReloadPatience;;) {
    auto all = askOnce(options, roles);
    const bool again =
        !all && clock.now() < until && std::ranges::any_of(roles, [&](const FoundRole& role) {
          return startsAgain(options.instance, role);
        });
    if (!again) return all;
    clock.sleepUntil(clock.now() + kReloadPollPeriod, {});
  }
}

// Prints which lost roles were not asked, and returns the exit status of the command. `status`:
// exit status for the roles that were asked. With --pid, no other process is expected to run, so
// nothing is printed.
int withLostRoles(const ReloadOptions& options, const std::vector<Reloaded>& asked, int status) {
  if (options.pid > 0) return status;
  const auto lost = lostRoles(options.instance);
  for (const LostRole& role : lost) {
    printError("merlin: {}: the role {} {}; it was not asked, and reads the file when it starts\n",
               options.instance, role.role, role.what());
    if (status != kExitDone || asked.empty()) continue;
    printError(
        "merlin: {}: the role {} {} the reload; the exit status is {} until the role {} has been "
        "started again. To reload without that role: merlin reload --pid {}\n",
        options.instance, asked.front().process.role, options.check ? "can do" : "has done",
        kExitFailed, role.role, asked.front().process.pid);
  }
  return lost.empty() || status != kExitDone ? status : kExitFailed;
}

int reloadInstance(ReloadOptions options) {
  std::vector<FoundRole> roles;
  const auto all = ask(options, roles);
  if (!all) return fail(all.error());
  const bool awaits = options.pid == 0 && !options.check && !renames(*all);
  if (const auto back = awaits ? awaitStarts(options.instance, *all) : Ok{}; !back)
    return fail(back.error());
  if (!options.json) {
    print(*all, readersOf(roles), options.check ? "would start" : awaits ? "started" : "starts");
    return withLostRoles(options, *all, exitStatusOf(*all));
  }
  Json processes = Json::array();
  for (const Reloaded& reloaded : *all) {
    Json process{{"pid", reloaded.process.pid}};
    process.update(reloaded.answer);
    processes.push_back(std::move(process));
  }
  printJsonLine(Json{{"processes", std::move(processes)}});
  return withLostRoles(options, *all, exitStatusOf(*all));
}

}  // namespace

int reloadNow(const std::string& instance) {
  ReloadOptions options;
  options.instance = instance;
  return reloadInstance(std::move(options));
}

void addReload(Command app, Run& run) {
  const auto options = std::make_shared<ReloadOptions>();
  Command command = app.subcommand(
      "reload",
      "Have merlind read its configuration again and swap what changed, without closing anything "
      "else: bindings, devices, hand, postures, rate, playlist, speeds. For other settings the "
      "process that reads them starts again, in about a second. All or nothing: if the file is "
      "invalid, everything stays as it was. Exit status: 0 done, 2 invalid, 1 otherwise, also if a "
      "role of the instance was killed or hangs, whatever the other one has done: until that role "
      "has been started again, --pid reloads the other one alone.\n"
      "Example: merlin reload --check");
  addInstance(command, options->instance);
  command
      .option("--pid", options->pid,
              "The daemon of this process, instead of --instance (for systemd's ExecReload=)")
      .typeName("PID");
  command.flag("--check", options->check,
               "Only print what would be swapped, what needs a restart, and which outputs' "
               "alignments would be set aside since they do not fit any more, or would come back "
               "since they fit again");
  command.flag("--json", options->json, "Print JSON, for programs");
  command.callback([options, &run] { run = [options] { return reloadInstance(*options); }; });
}

}  // namespace merlin::cli
