#include "daemon/manual/man_page.h"

#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/manual/roff.h"

namespace merlin::manual {
namespace {

// The statuses of daemon/cli/exit_status.h.
constexpr const char* kExitStatus =
    ".SH EXIT STATUS\n"
    ".TP\n\\fB0\\fR\ndone\n"
    ".TP\n\\fB1\\fR\nfailed while running\n"
    ".TP\n\\fB2\\fR\nbad usage or bad input\n"
    ".TP\n\\fB3\\fR\nalready running\n";

// "-o, --output FILE"
std::string title(const ProgramOption& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.names) names.push_back(roffBold(name));
  std::string text = fmt::format("{}", fmt::join(names, ", "));
  if (!option.value.empty()) text += " " + roffItalic(option.value);
  return text + (option.repeats ? " ..." : "");
}

// What the help says in brackets: values, default, whether it is needed.
std::string limits(const ProgramOption& option) {
  std::vector<std::string> said;
  if (!option.choices.empty())
    said.push_back(fmt::format("one of {}", fmt::join(option.choices, ", ")));
  if (!option.range.empty()) said.push_back(option.range);
  if (!option.default_value.empty()) said.push_back("default " + option.default_value);
  if (option.required) said.emplace_back("required");
  return said.empty() ? "" : roffText(fmt::format("({})", fmt::join(said, "; "))) + "\n";
}

std::string described(const ProgramOption& option, const std::string& shown) {
  std::string text = ".TP\n" + shown + "\n" + roffLines(option.help) + limits(option);
  if (option.help.empty() && limits(option).empty()) text += "\\&\n";
  return text;
}

// A positional argument as a usage line shows it.
std::string shownValue(const ProgramOption& positional) {
  std::string value =
      roffItalic(positional.value.empty() ? positional.names.front() : positional.value);
  if (positional.repeats) value += " ...";
  return positional.required ? value : "[" + value + "]";
}

std::string usage(const ProgramCommand& command, const std::string& path) {
  std::string text = roffBold(path);
  if (!command.commands.empty()) text += " " + roffItalic("COMMAND");
  for (const ProgramOption& positional : command.positionals) text += " " + shownValue(positional);
  if (!command.options.empty()) text += " [" + roffItalic("OPTION") + " ...]";
  return text;
}

std::string arguments(const ProgramCommand& command) {
  std::string text;
  for (const ProgramOption& p : command.positionals) text += described(p, shownValue(p));
  for (const ProgramOption& o : command.options) text += described(o, title(o));
  return text;
}

// A section for each command that has none below it, and for one with arguments of its own.
void addCommands(const ProgramCommand& command, const std::string& path, std::string& page) {
  for (const ProgramCommand& sub : command.commands) {
    const std::string name = path + " " + sub.name;
    page += ".SS\n" + usage(sub, name) + "\n" + roffLines(sub.help) + arguments(sub);
    addCommands(sub, name, page);
  }
}

}  // namespace

std::string manPage(const ProgramCommand& program, const PageSettings& settings,
                    const std::string& version) {
  std::string page = roffTitle(settings.name, settings.section, version);
  page += ".SH NAME\n" + roffText(settings.name) + " \\- " + roffText(settings.summary) + "\n";
  page += ".SH SYNOPSIS\n" + usage(program, settings.name) + "\n";
  page += ".SH DESCRIPTION\n" + roffLines(program.help);
  page += ".SH OPTIONS\n" + arguments(program);
  if (!program.commands.empty()) page += ".SH COMMANDS\n";
  addCommands(program, settings.name, page);
  page += kExitStatus;
  if (!settings.files.empty()) page += ".SH FILES\n";
  for (const PageSettings::File& file : settings.files)
    page += ".TP\n" + roffItalic(file.path) + "\n" + roffText(file.what) + "\n";
  std::vector<std::string> others;
  for (const std::string& other : settings.see_also) {
    const std::size_t bracket = other.find('(');
    others.push_back(roffBold(other.substr(0, bracket)) + other.substr(bracket));
  }
  return page + fmt::format(".SH SEE ALSO\n{}\n", fmt::join(others, ",\n"));
}

}  // namespace merlin::manual
