// The manual pages and completions that the programs print, checked by groff and bash.
#include <string>

#include <gtest/gtest.h>

#include "daemon/manual/bash_completion.h"
#include "daemon/manual/man_page.h"
#include "daemon/manual/roff.h"
#include "tests/system/merlind.h"

namespace merlin::manual {
namespace {

using test::kMerlin, test::kMerlind, test::run;

TEST(RoffText, TakesNothingForAnInstruction) {
  EXPECT_EQ(roffText(".conf"), "\\&.conf");
  EXPECT_EQ(roffText("'a' \\n"), "\\&'a' \\en");
  EXPECT_EQ(roffText("full-size --all -1"), "full-size \\-\\-all \\-1");
  EXPECT_EQ(roffBold("full-size"), "\\fBfull\\-size\\fR") << "it may be a command's name";
  EXPECT_EQ(roffLines("What.\n\nExample: x -o y"), "What.\n.br\nExample: \\fBx \\-o y\\fR\n");
}

ProgramCommand program() {
  return {.name = "cut",
          .help = "Cuts.",
          .options = {{.names = {"-h", "--help"}, .help = "Help"}},
          .commands = {{.name = "paper",
                        .help = "Cut paper.\nExample: cut paper --into 3",
                        .options = {{.names = {"--into"},
                                     .value = "N",
                                     .range = "1 to 9",
                                     .default_value = "2",
                                     .help = "Number of parts"},
                                    {.names = {"--edge"},
                                     .value = "TEXT",
                                     .choices = {"straight", "wavy"},
                                     .required = true}},
                        .positionals = {{.names = {"sheet"}, .value = "FILE", .repeats = true}}}}};
}

TEST(ManPage, HasEveryCommandWithItsOptions) {
  const std::string page =
      manPage(program(), {.name = "cut", .summary = "cuts things", .see_also = {"fold(1)"}}, "3.1");
  for (const char* line :
       {".TH \"CUT\" 1 \"\" \"MERLIN 3.1\"", "cut \\- cuts things\n",
        ".SS\n\\fBcut paper\\fR [\\fIFILE\\fR ...] [\\fIOPTION\\fR ...]\nCut paper.\n",
        "Example: \\fBcut paper \\-\\-into 3\\fR\n",
        ".TP\n\\fB\\-\\-into\\fR \\fIN\\fR\nNumber of parts\n(1 to 9; default 2)\n",
        "\\fB\\-\\-edge\\fR \\fITEXT\\fR\n(one of straight, wavy; required)\n",
        ".SH SEE ALSO\n\\fBfold\\fR(1)\n"})
    EXPECT_NE(page.find(line), std::string::npos) << line << "\n" << page;
}

// Returns the completions that bash offers for these words, the last of which is incomplete.
std::string offered(const std::string& script, const std::string& words) {
  return run({"bash", "-c",
              script + "\nCOMP_WORDS=(" + words +
                  ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_${COMP_WORDS[0]}\n"
                  "echo \"${COMPREPLY[@]}\""})
      .output;
}

TEST(BashCompletion, OffersWhatMayFollow) {
  const std::string script = bashCompletion(program(), "cut");
  EXPECT_EQ(offered(script, "cut ''"), "paper -h --help\n");
  EXPECT_EQ(offered(script, "cut paper --e"), "--edge\n");
  EXPECT_EQ(offered(script, "cut paper --edge ''"), "straight wavy\n");
  EXPECT_EQ(offered(script, "cut paper --into ''"), "\n") << "bash offers files";
  EXPECT_EQ(offered(script, "cut paper x.png --in"), "--into\n");
}

TEST(BashCompletion, KnowsTheProgramsOfThisBuild) {
  const std::string script = run({kMerlin, "--print-completion"}).output;
  EXPECT_EQ(offered(script, "merlin mesh re"), "reduce\n");
  EXPECT_EQ(offered(script, "merlin wall testcard fo"), "focus\n");
  EXPECT_EQ(offered(script, "merlin playlist n"), "next\n");
  EXPECT_EQ(offered(run({kMerlind, "--print-completion"}).output, "merlind --role d"), "devices\n");
}

TEST(ManPage, OfEachProgramIsCleanAndComplete) {
  if (run({"which", "groff"}).status != 0) GTEST_SKIP() << "groff is not installed";
  const struct {
    std::vector<std::string> print;
    const char* has;
  } pages[] = {{{kMerlin, "--print-manual"}, "merlin mesh reduce"},
               {{kMerlind, "--print-manual"}, "--check-config FILE"},
               {{kMerlind, "--print-manual"}, "merlin-alarms.service.d"},
               {{kMerlind, "--print-manual"}, "SIGUSR1"},
               {{kMerlind, "--print-config-manual"}, "/wall/tiles/tiles/0"}};
  for (const auto& page : pages) {
    const test::TempDir dir;
    test::writeText(dir / "page", run(page.print).output);
    const test::Outcome shown = run({"groff", "-man", "-Tascii", "-ww", "-rCHECKSTYLE=3", "-P-c",
                                     "-P-b", "-P-u", "-rLL=200n", dir / "page"});
    EXPECT_EQ(shown.output.find(dir / "page"), std::string::npos)
        << "groff warns: " << shown.output.substr(0, 500);
    EXPECT_NE(shown.output.find(page.has), std::string::npos) << page.has;
  }
}

}  // namespace
}  // namespace merlin::manual
