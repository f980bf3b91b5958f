// merlin config edit: a person edits a copy, which takes the file's place only once it is valid.
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/base/child_process.h"
#include "daemon/cli/config/config.h"
#include "daemon/cli/config/edited_file.h"
#include "daemon/cli/exit_status.h"
#include "daemon/cli/print.h"
#include "daemon/cli/roles.h"
#include "daemon/cli/wall/reload.h"

namespace merlin::cli {
namespace {

using Verdict = LoadedSettings::Verdict;

std::string editorName() {
  for (const char* variable : {"VISUAL", "EDITOR"}) {
    const char* const set = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): one thread
    if (set && *set) return set;
  }
  return "editor";  // Debian's command for the editor that the system has chosen
}

// While this object exists, this process ignores SIGINT and SIGQUIT, so that Ctrl-C affects only
// the editor.
class KeyboardSignalsIgnored {
 public:
  KeyboardSignalsIgnored()
      : interrupt_(std::signal(SIGINT, SIG_IGN)), quit_(std::signal(SIGQUIT, SIG_IGN)) {}
  ~KeyboardSignalsIgnored() {
    std::signal(SIGINT, interrupt_);
    std::signal(SIGQUIT, quit_);
  }
  KeyboardSignalsIgnored(const KeyboardSignalsIgnored&) = delete;
  KeyboardSignalsIgnored& operator=(const KeyboardSignalsIgnored&) = delete;

 private:
  void (*interrupt_)(int);
  void (*quit_)(int);
};

// Runs the editor on the file and waits until it ends. `editor`: a command line for the shell.
// Errors: kIo (the editor cannot be started, or it failed).
Result<Ok> runEditor(const std::string& editor, const std::string& file) {
  const std::string line = editor + " \"$1\"";
  const KeyboardSignalsIgnored ignored;
  const auto child = startChild();
  if (!child) return child.error();
  if (*child == 0) {
    ::signal(SIGINT, SIG_DFL);
    ::signal(SIGQUIT, SIG_DFL);
    ::execl("/bin/sh", "sh", "-c", line.c_str(), "sh", file.c_str(), nullptr);
    ::_exit(127);
  }
  const int status = waitForChild(*child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return Ok{};
  return Error{
      Errc::kIo,
      fmt::format("the editor \"{}\" (VISUAL or EDITOR names another one) failed{}", editor,
                  WIFEXITED(status) ? fmt::format(", exit status {}", WEXITSTATUS(status))
                                    : std::string(": it was ended by a signal"))};
}

// Repeats the question until the answer begins with one of `letters`, and returns that letter;
// nothing at the end of the input.
std::optional<char> ask(const std::string& question, std::string_view letters) {
  for (std::string answer;
       printOut("{} ", question), std::fflush(stdout), std::getline(std::cin, answer);) {
    if (!answer.empty() && letters.find(answer[0]) != std::string_view::npos) return answer[0];
  }
  printOut("\n");
  return std::nullopt;
}

// Loads the copy as a configuration, and prints its findings with the name of the original file.
LoadedSettings check(const EditedFile& edited) {
  LoadedSettings loaded = loadSettingsFile(edited.copy());
  for (const Finding& finding : loaded.findings) printError("{}\n", toText(edited.path(), finding));
  if (loaded.left_out > 0)
    printError("{}: and {} more findings\n", oneLine(edited.path()), loaded.left_out);
  return loaded;
}

int keepOld(const EditedFile& edited, int status) {
  printOut("{}: not changed\n", edited.path());
  return status;
}

int offerReload(const std::string& instance) {
  if (!findRoles(instance)) return kExitDone;  // no merlind runs that could read the file
  const auto answer =
      ask(fmt::format("merlind \"{}\" is running. Have it read its configuration now? (y)es, (n)o:",
                      instance),
          "yn");
  return answer == 'y' ? reloadNow(instance) : kExitDone;
}

int save(EditedFile& edited, const LoadedSettings& loaded) {
  if (const auto replaced = edited.replace(); !replaced) {
    edited.keepCopy();
    printNote(fmt::format("your edits are kept in {}", edited.copy()));
    return fail(replaced.error());
  }
  printOut("{}: saved\n", edited.path());
  return offerReload(loaded.settings.instance);
}

// Lets the person edit the copy until it is valid and saved, or until the person keeps the old
// file.
int editFile(const std::string& path) {
  auto edited = EditedFile::open(path);
  if (!edited) return fail(edited.error());
  const std::string editor = editorName();
  for (;;) {
    if (const auto done = runEditor(editor, edited->copy()); !done) {
      keepOld(*edited, kExitFailed);
      return fail(done.error());
    }
    const auto changed = edited->hasChanged();
    if (!changed) return fail(changed.error());
    if (!*changed) return keepOld(*edited, kExitDone);
    const LoadedSettings loaded = check(*edited);
    if (loaded.verdict() == Verdict::kValid) return save(*edited, loaded);
    const bool invalid = loaded.verdict() == Verdict::kInvalid;
    const auto answer =
        invalid ? ask("The edited file is invalid. (e)dit again, (k)eep the old one:", "ek")
                : ask("Some numbers are out of range. (e)dit again, (k)eep the old one, (s)ave:",
                      "eks");
    if (answer == 's') return save(*edited, loaded);
    if (answer == 'k') return keepOld(*edited, invalid ? kExitBadInput : kExitDone);
    if (answer) continue;
    edited->keepCopy();  // the input has ended, so the edits are kept in the copy
    printNote(fmt::format("your edits are kept in {}", edited->copy()));
    return keepOld(*edited, kExitBadInput);
  }
}

}  // namespace

void addConfigEdit(Command config, Run& run) {
  const auto file = std::make_shared<std::string>(kUsualConfig);
  Command command = config.subcommand(
      "edit",
      "Edit a copy of a configuration with $VISUAL or $EDITOR and check it. Findings are shown "
      "with "
      "their lines, and it can be edited again; only a valid copy replaces the file, in one step "
      "and with the same owner and mode. You are then asked whether a running merlind is to read "
      "it.\n"
      "Example: sudo merlin config edit");
  command.option("file", *file, "The configuration file").typeName("FILE").showDefault();
  command.callback([file, &run] { run = [file] { return editFile(*file); }; });
}

}  // namespace merlin::cli
