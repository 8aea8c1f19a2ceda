// Texts of input errors. Expectations: the format promised in error.hpp, "file:line: what; remedy".
#include <gtest/gtest.h>

#include "core/error.hpp"

namespace alphadot {
namespace {

TEST(Problem, NamesFileLineAndRemedy) {
  EXPECT_EQ((Problem{"case.toml", 7, "mach is negative", "give a positive number"}).text(),
            "case.toml:7: mach is negative; give a positive number");
}

TEST(Problem, LeavesOutWhatIsUnknown) {
  EXPECT_EQ((Problem{"box.msh", 0, "the file is empty", "export it again"}).text(),
            "box.msh: the file is empty; export it again");
  EXPECT_EQ((Problem{"", 0, "no free memory", ""}).text(), "no free memory");
  EXPECT_EQ((Problem{"case.toml", 3, "unknown key", ""}).text(), "case.toml:3: unknown key");
}

TEST(Problem, ShowsNoLineWithoutAFile) {
  EXPECT_EQ((Problem{"", 12, "bad value", "mend it"}).text(), "bad value; mend it");
}

TEST(InputError, PutsEveryProblemOnALine) {
  const InputError error(std::vector<Problem>{{"a.toml", 1, "one", "mend it"}, {"a.toml", 2, "two", ""}});
  EXPECT_STREQ(error.what(), "a.toml:1: one; mend it\na.toml:2: two");
  ASSERT_EQ(error.problems().size(), 2u);
  EXPECT_EQ(error.problems()[1].line, 2);
}

TEST(InputError, IsMadeOfOneProblem) {
  const InputError error("a.toml", 4, "what", "remedy");
  EXPECT_STREQ(error.what(), "a.toml:4: what; remedy");
  ASSERT_EQ(error.problems().size(), 1u);
  EXPECT_EQ(error.problems()[0].file, "a.toml");
  EXPECT_EQ(error.problems()[0].what, "what");
  EXPECT_EQ(error.problems()[0].remedy, "remedy");
}

}  // namespace
}  // namespace alphadot
