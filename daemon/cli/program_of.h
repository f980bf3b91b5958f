// Extracts the description of a CLI11 command line, as data for manual pages and completion. To be
// included only by files that include CLI11 anyway.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "daemon/manual/program.h"

namespace merlin::cli {

// Splits the text at each `by`; the result has at least one part.
inline std::vector<std::string> divided(std::string_view text, char by) {
  std::vector<std::string> parts;
  while (true) {
    const std::size_t end = text.find(by);
    parts.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

// Fills in the placeholder, the choices and the range of an option's value. CLI11 has them in one
// text: "FLOAT:FLOAT in [1 - 9]", "TEXT:{left,right}". A placeholder of lower-case words, such as
// "on|off", lists the choices; "NAME|FILE" does not.
inline void setValue(const CLI::Option& option, manual::ProgramOption& facts) {
  const std::string whole = option.get_type_name();
  const std::size_t colon = whole.find(':');
  facts.value = whole.substr(0, colon);
  const bool words = std::all_of(facts.value.begin(), facts.value.end(),
                                 [](char c) { return c == '|' || (c >= 'a' && c <= 'z'); });
  if (words && facts.value.find('|') != std::string::npos)
    facts.choices = divided(facts.value, '|');
  if (colon == std::string::npos) return;
  std::string range = whole.substr(colon + 1);
  if (range.starts_with('{') && range.ends_with('}')) {
    facts.choices = divided(std::string_view(range).substr(1, range.size() - 2), ',');
    return;
  }
  if (const std::size_t from = range.find(" in ["); from != std::string::npos) {
    range = range.substr(from + 5, range.size() - from - 6);
    if (const std::size_t dash = range.find(" - "); dash != std::string::npos)
      range.replace(dash, 3, " to ");
  }
  if (range == "POSITIVE" || range == "NONNEGATIVE")
    range = range == "POSITIVE" ? "above 0" : "0 or above";
  facts.range = range;
}

// Describes an option or a positional argument.
inline manual::ProgramOption optionOf(const CLI::Option& option) {
  manual::ProgramOption facts;
  for (const std::string& name : option.get_snames()) facts.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) facts.names.push_back("--" + name);
  if (facts.names.empty()) facts.names.push_back(option.get_name(true));
  if (option.get_type_size() != 0) setValue(option, facts);
  facts.help = option.get_description();
  facts.default_value = option.get_default_str();
  facts.required = option.get_required();
  facts.repeats = option.get_expected_max() > 1;
  return facts;
}

// Adds the visible options and positional arguments of `app` to `command`. `top`: whether `app` is
// the program itself; --help is left out otherwise.
inline void addOptions(const CLI::App& app, bool top, manual::ProgramCommand& command) {
  for (const CLI::Option* option : app.get_options({})) {
    if (option->get_group().empty() || (!top && option == app.get_help_ptr())) continue;
    (option->nonpositional() ? command.options : command.positionals).push_back(optionOf(*option));
  }
}

// Describes a command with its options and, recursively, its subcommands. `top`: whether `app` is
// the program itself.
inline manual::ProgramCommand programOf(const CLI::App& app, bool top = true) {
  manual::ProgramCommand command;
  command.name = app.get_name();
  command.help = app.get_description();
  addOptions(app, top, command);
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (sub->get_name().empty())
      addOptions(*sub, false, command);  // a group of options
    else
      command.commands.push_back(programOf(*sub, false));
  }
  return command;
}

}  // namespace merlin::cli
