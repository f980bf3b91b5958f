// Describes what is wrong with a program's arguments, in one sentence; CLI11's own sentence names
// neither the subcommand nor the unknown word. To be included only by files that include CLI11
// anyway.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/base/did_you_mean.h"
#include "daemon/base/printable_text.h"

namespace merlin::cli {

// The innermost command on the command line, and the words that select it, "merlin mesh info".
struct GivenCommand {
  const CLI::App* app;
  std::string words;
};

// Returns the innermost command that was given. `program`: name of the program, the first of the
// words.
inline GivenCommand givenCommand(const CLI::App& app, const std::string& program) {
  GivenCommand given{&app, program};
  while (true) {
    const CLI::App* next = nullptr;
    for (const CLI::App* sub : given.app->get_subcommands()) {
      if (!sub->get_name().empty()) next = sub;  // a group of options has no name
    }
    if (!next) return given;
    given.app = next;
    given.words += " " + next->get_name();
  }
}

// Returns the names of the subcommands of `app`; groups of options, which have no name, are left
// out.
inline std::vector<std::string> commandsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!sub->get_name().empty()) names.push_back(sub->get_name());
  }
  return names;
}

// Returns the long names of the options of `app` and of its groups of options, "--name".
inline std::vector<std::string> optionsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options({})) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!sub->get_name().empty()) continue;
    const std::vector<std::string> more = optionsOf(*sub);
    names.insert(names.end(), more.begin(), more.end());
  }
  return names;
}

// Returns the sentence about an unexpected word. `needs_command`: whether the name of a command was
// expected in its place.
inline std::string unknownWord(const GivenCommand& given, const std::string& word,
                               bool needs_command) {
  const CLI::App& app = *given.app;
  const bool is_option = word.starts_with('-');
  const std::vector<std::string> known = is_option ? optionsOf(app) : commandsOf(app);
  const std::string near = nearestWord(word, known);
  const std::string quoted = is_option ? excerpt(word) : fmt::format("\"{}\"", excerpt(word));
  if (is_option && near == word)
    return fmt::format("{} has to come after the command: {} {}", quoted, given.words, quoted);
  if (!near.empty())
    return fmt::format("{} is not {}; did you mean {}?", quoted,
                       is_option ? "an option" : "a command", near);
  if (is_option) return fmt::format("{} is not an option", quoted);
  if (needs_command)
    return fmt::format("{} is not a command; commands are {}", quoted, fmt::join(known, ", "));
  return fmt::format("{} is one argument too many", quoted);
}

// Rewords CLI11's message "Could not convert: --threads = x" to "--threads = x: that is not a
// number"; other messages are returned unchanged.
inline std::string unconverted(std::string what) {
  constexpr std::string_view kTheirs = "Could not convert: ";
  if (what.starts_with(kTheirs)) what = what.substr(kTheirs.size()) + ": that is not a number";
  return what;
}

// Returns the message for `error`: the command, what is wrong, and a second line that refers to
// --help.
inline std::string argumentFault(const CLI::App& app, const std::string& program,
                                 const CLI::ParseError& error) {
  const GivenCommand given = givenCommand(app, program);
  const std::vector<std::string> left = app.remaining(true);
  const bool needs_command =
      given.app->get_require_subcommand_min() > 0 && !commandsOf(*given.app).empty();
  const std::string what =
      !left.empty()   ? unknownWord(given, left.front(), needs_command)
      : needs_command ? fmt::format("needs a command: {}", fmt::join(commandsOf(*given.app), ", "))
                      : unconverted(error.what());
  return fmt::format("{}: {}\n{} --help describes {}\n", given.words, printable(what), given.words,
                     needs_command ? "them" : "it");
}

}  // namespace merlin::cli
