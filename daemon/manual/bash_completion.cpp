#include "daemon/manual/bash_completion.h"

#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace merlin::manual {
namespace {

// Rows of three case statements: the commands that there are, the words that may follow each, and
// the values of options.
struct Tables {
  std::vector<std::string> commands;
  std::string words, values;
};

void addCommand(const ProgramCommand& command, const std::string& path, Tables& tables) {
  std::vector<std::string> words;
  for (const ProgramCommand& sub : command.commands) words.push_back(sub.name);
  for (const ProgramOption& p : command.positionals)
    words.insert(words.end(), p.choices.begin(), p.choices.end());
  for (const ProgramOption& option : command.options) {
    words.insert(words.end(), option.names.begin(), option.names.end());
    if (option.value.empty()) continue;
    std::vector<std::string> pattern;
    for (const std::string& name : option.names)
      pattern.push_back(fmt::format("\"{} {}\"", path, name));
    tables.values +=
        fmt::format("    {}) values=\"{}\" ;;\n", fmt::join(pattern, " | "),
                    option.choices.empty() ? std::string("-")
                                           : fmt::format("{}", fmt::join(option.choices, " ")));
  }
  tables.words += fmt::format("    \"{}\") words=\"{}\" ;;\n", path, fmt::join(words, " "));
  for (const ProgramCommand& sub : command.commands) {
    tables.commands.push_back(fmt::format("\"{} {}\"", path, sub.name));
    addCommand(sub, path + " " + sub.name, tables);
  }
}

// The commands among the words before the cursor. A program without commands has none to look for.
std::string search(const Tables& tables) {
  if (tables.commands.empty()) return "";
  return fmt::format(
      R"(  local word
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case "$command $word" in
    {}) command+=" $word" ;;
    esac
  done
)",
      fmt::join(tables.commands, " | \\\n    "));
}

}  // namespace

// `values` is "-" where any value may follow: then, and where no word fits, bash completes files.
std::string bashCompletion(const ProgramCommand& program, const std::string& name) {
  Tables tables;
  addCommand(program, name, tables);
  std::string function = name;
  for (char& c : function) c = c == '-' ? '_' : c;
  return fmt::format(R"(# Completion for {0}, made by {0} --print-completion.
_{1}() {{
  local command="{0}" words="" values=""
  local current="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}"
  COMPREPLY=()
{2}  case "$command $before" in
{3}  esac
  case "$command" in
{4}  esac
  if [ "$values" = - ]; then return; fi
  if [ -n "$values" ]; then words="$values"; fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}}
complete -o default -F _{1} {0}
)",
                     name, function, search(tables), tables.values, tables.words);
}

}  // namespace merlin::manual
