// Expectations: the TOML 1.0 grammar, the list of keys and limits in the description of the keys
// (case_keys.cpp), and the line numbers of the texts below counted by hand.
#include "case_file/case_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "case_file/case_keys.hpp"
#include "case_file/suggestion.hpp"
#include "core/error.hpp"
#include "derivatives/case.hpp"
#include "euler/kinds.hpp"
#include "march/settings.hpp"
#include "motion/settings.hpp"
#include "space/settings.hpp"
#include "support/counted_memory.hpp"

namespace alphadot {
namespace {

using testing_support::memory;

const std::string minimal = R"(
[mesh]
file = "finner.msh"
[freestream]
mach = 2.5
[boundary]
body = "wall"
)";

const std::string full = R"(title = "Basic Finner \"plunge\" é"
[mesh]
file = "mesh/coarse.msh"
scale = 0.0254
[reference]
length = 2
area = 3.14159265358979312
moment_center = [5.5, 0, -1e-300]
model = "half"
[freestream]
mach = 2.5
alpha = 1.5
gamma = 1.3
[boundary]
body = "wall"
"base 2" = "jet"
sting.x = 3
[space]
flux = "van_leer"
order = 1
)";

std::vector<Problem> problems_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse_case(text, "case.toml", overrides);
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

/// Equal in every key: `resolved_case` writes all of them with all their digits.
void expect_same(const Case& a, const Case& b) {
  EXPECT_EQ(resolved_case(a), resolved_case(b));
}

TEST(CaseFile, MinimalCaseHasTheDefaults) {
  const Case c = parse_case(minimal, "cases/finner/plunge.toml");
  EXPECT_EQ(c.file, "cases/finner/plunge.toml");
  EXPECT_EQ(c.mesh.file, (std::filesystem::current_path() / "cases/finner/finner.msh").string());
  EXPECT_EQ(c.freestream.mach, 2.5);
  EXPECT_EQ(c.boundary.size(), 1u);
  EXPECT_EQ(c.boundary.at("body"), BoundaryKind::wall);
  EXPECT_EQ(c.output.folder, "runs/plunge");
  EXPECT_EQ(c.freestream.gamma, Case{}.freestream.gamma);
  EXPECT_EQ(c.steady.max_iterations, Case{}.steady.max_iterations);
}

TEST(CaseFile, AxisPointFollowsTheMomentCenterUnlessGiven) {
  const Case c = parse_case(minimal, "a.toml", {"reference.moment_center=[5.5, 0, 1]"});
  EXPECT_EQ(c.motion.axis_point.x, 5.5);
  EXPECT_EQ(c.motion.axis_point.z, 1);
  const Case d =
      parse_case(minimal, "a.toml", {"reference.moment_center=[5.5,0,1]", "motion.axis_point=[1,2,3]"});
  EXPECT_EQ(d.motion.axis_point.x, 1);
}

TEST(CaseFile, OverridesReplaceTheFile) {
  const Case c = parse_case(minimal, "a.toml",
                            {"freestream.mach=3", "space.flux=van_leer", "boundary.body=sting",
                             "boundary.a.b=\"jet\"", "title=2024", "output.flow=false", "freestream.mach=4"});
  EXPECT_EQ(c.freestream.mach, 4);  // the last one counts
  EXPECT_EQ(c.space.flux, FluxKind::van_leer);
  EXPECT_EQ(c.boundary.at("body"), BoundaryKind::sting);
  EXPECT_EQ(c.boundary.at("a.b"), BoundaryKind::jet);
  EXPECT_EQ(c.title, "2024");
  EXPECT_FALSE(c.output.flow);
}

TEST(CaseFile, AnOverrideMendsAWrongValue) {
  EXPECT_TRUE(problems_of(minimal + "[space]\norder = 7\n", {"space.order=1"}).empty());
}

TEST(CaseFile, ResolvedCaseReadsBackTheSame) {
  std::string text = full;
  text.replace(text.find("sting.x = 3\n"), 12, "");
  Case c = parse_case(text, "folder/case.toml",
                      {"motion.kind=ramp_alpha", "unsteady.duration=0.1", "unsteady.steps=33",
                       "motion.table_file=a\\b \"c\"\t.csv", "space.entropy_fix=1e-17", "output.folder=x y"});
  EXPECT_EQ(c.reference.moment_center.z, -1e-300);
  EXPECT_TRUE(c.reference.half_model);
  expect_same(parse_case(resolved_case(c), "elsewhere/resolved.toml"), c);
  expect_same(parse_case(resolved_case(parse_case(minimal, "a.toml")), "/b/c.toml"),
              parse_case(minimal, "a.toml"));
}

TEST(CaseFile, EveryKeyWithEveryWordReadsBackTheSame) {
  const auto check = [](const std::string& key, auto value) {
    const std::string word = word_of(value);
    const Case c = parse_case(
        minimal, "a.toml",
        {key + "=" + word, "unsteady.duration=1", "unsteady.steps=20", "motion.table_file=t",
         "gust.table_file=g", "body.free=[\"pitch\", \"heave\"]", "body.mass=2", "body.inertia=[0, 3, 0]"});
    EXPECT_NE(resolved_case(c).find("\"" + word + "\""), std::string::npos) << key << " " << word;
    expect_same(parse_case(resolved_case(c), "b.toml"), c);
  };
  for (const auto& word : words_of<FluxKind>) check("space.flux", word.value);
  for (const auto& word : words_of<GradientKind>) check("space.gradient", word.value);
  for (const auto& word : words_of<LimiterKind>) check("space.limiter", word.value);
  for (const auto& word : words_of<SchemeKind>) check("steady.scheme", word.value);
  for (const auto& word : words_of<MotionKind>) check("motion.kind", word.value);
  for (const auto& word : words_of<TreatmentKind>) check("motion.treatment", word.value);
  for (const auto& word : words_of<BoundaryKind>) check("boundary.body", word.value);
  for (const auto& word : words_of<GustKind>) check("gust.kind", word.value);
  for (const auto& word : words_of<GustDirection>) check("gust.direction", word.value);
}

TEST(CaseFile, DocumentationNamesEveryKey) {
  const std::string text = describe_case_keys();
  for (const auto& key : case_keys())
    EXPECT_NE(text.find(key.is_family() ? "<name>" : key.name()), std::string::npos) << key.path;
  EXPECT_NE(text.find("a number from 1.01 to 5, default 1.4"), std::string::npos);
}

/// What the key makes of a text of TOML; nothing when it takes it.
std::string answer_of(const CaseKey& key, const std::string& value) {
  Case c;
  try {
    const auto table = toml::parse("value = " + value);
    const auto problem = key.read(key.name(), *table.get("value"), c);
    return problem ? problem->what : "";
  } catch (const toml::parse_error& error) {
    return error.what();
  }
}

// Every key that takes numbers says which, takes both ends, and refuses what is beyond, in any spelling.
TEST(CaseFile, NumbersHaveLimits) {
  std::size_t numbers = 0;
  for (const auto& key : case_keys()) {
    const bool is_number = key.type.find("number") != std::string::npos;
    const bool is_integer = key.type.find("integer") != std::string::npos;
    ASSERT_EQ(key.limits.has_value(), is_number || is_integer) << key.path;
    if (!key.limits) continue;
    ++numbers;
    const auto [from, to] = *key.limits;
    ASSERT_TRUE(std::isfinite(from) && std::isfinite(to) && from < to) << key.path;
    EXPECT_NE(describe_case_keys().find(fmt::format("from {} to {}", from, to)), std::string::npos)
        << key.path;
    const bool is_vector = key.type.starts_with("three");
    const auto answer = [&](const std::string& value) {
      return answer_of(key, is_vector ? "[0.5, " + value + ", 0.5]" : value);
    };
    const auto text = [&](Real value) {
      return is_integer ? std::to_string(static_cast<std::int64_t>(value)) : fmt::format("{:#.17g}", value);
    };
    const Real step = is_integer ? 1 : std::numeric_limits<Real>::infinity();
    const auto beyond = [&](Real limit, Real sign) {
      return is_integer ? limit + sign * step : std::nextafter(limit, sign * step);
    };
    for (const auto& good : {text(from), text(to)}) EXPECT_EQ(answer(good), "") << key.path << " = " << good;
    for (const std::string& bad :
         {text(beyond(from, -1)), text(beyond(to, 1)), std::string("nan"), std::string("-nan"),
          std::string("inf"), std::string("-inf"), std::string("1e300"), std::string("-1e300"),
          std::string("9223372036854775807"), std::string("-9223372036854775808"),
          std::string("18446744073709551617")})
      EXPECT_NE(answer(bad), "") << key.path << " = " << bad;
    // What becomes an allowed number when it is cut to 32 bits.
    if (is_integer) {
      const auto wrapped = (std::int64_t{1} << 32) + static_cast<std::int64_t>(from);
      EXPECT_NE(answer(std::to_string(wrapped)), "") << key.path;
    }
  }
  EXPECT_GT(numbers, 30u);
}

TEST(CaseFile, TextsHaveLimits) {
  for (const auto& key : case_keys()) {
    const bool is_list = key.type.starts_with("a list");
    if (!key.type.starts_with("text") && !is_list) continue;
    const auto quoted = [&](const std::string& text) {
      return is_list ? "[\"" + text + "\"]" : '"' + text + '"';
    };
    EXPECT_EQ(answer_of(key, quoted("abc")), "") << key.path;
    EXPECT_NE(answer_of(key, quoted(std::string(5000, 'x'))), "") << key.path;
    EXPECT_NE(answer_of(key, quoted("a\\u0000b")), "") << key.path;
  }
}

struct BadCase {
  const char* lines;  ///< replaces the line `mach = 2.5` (line 5) of `minimal`
  int line;
  const char* text;  ///< part of the one problem expected
};

class BadCases : public testing::TestWithParam<BadCase> {};

TEST_P(BadCases, GivesOneProblemWithItsLine) {
  std::string text = minimal;
  text.replace(text.find("mach = 2.5"), 10, GetParam().lines);
  const auto problems = problems_of(text);
  ASSERT_EQ(problems.size(), 1u) << text;
  EXPECT_EQ(problems[0].file, "case.toml");
  EXPECT_EQ(problems[0].line, GetParam().line) << problems[0].text();
  EXPECT_NE(problems[0].text().find(GetParam().text), std::string::npos) << problems[0].text();
}

INSTANTIATE_TEST_SUITE_P(
    CaseFile, BadCases,
    testing::Values(
        BadCase{"", 4, "freestream.mach is missing"},
        BadCase{"mach = -1", 5, "freestream.mach must be a number from 0.01 to 100, not -1"},
        BadCase{"mach = 0", 5, "not 0"}, BadCase{"mach = nan", 5, "not nan"},
        BadCase{"mach = inf", 5, "not inf"},
        BadCase{"mach = \"fast\"", 5, "must be a number from 0.01 to 100, not \"fast\""},
        BadCase{"mach = true", 5, "not true"}, BadCase{"mach = [1]", 5, "not an array of 1"},
        BadCase{"mach = 1979-05-27", 5, "not a date"}, BadCase{"mach.x = 2", 5, "not a table"},
        BadCase{"mach = 2\n[estimates]\nreynolds = 5000", 7, "estimates.reynolds = 5000 is below 10000"},
        BadCase{"mach = 2\n[estimates]\ntransition = 1", 7, "estimates.transition = 1 is below 10000"},
        BadCase{"mach = 2\ngamma = 1", 6, "must be a number from 1.01 to 5, not 1"},
        BadCase{"mach = 2\nalpha = 200", 6, "freestream.alpha must be a number from -180 to 180"},
        BadCase{"mach = 2\nmahc = 3", 6, "unknown key freestream.mahc; did you mean freestream.mach?"},
        BadCase{"mach = 2\nxyzzy = 3", 6, "unknown key freestream.xyzzy; alphadot keys"},
        BadCase{"mach = 2\nflux = \"roe\"", 6, "unknown key freestream.flux; did you mean space.flux?"},
        BadCase{"mach = 2\nmach = 3", 6, "mach"}, BadCase{"mach = ", 5, ""},
        BadCase{"mach = 2\n[spaze]\norder = 1", 6, "unknown key spaze; did you mean space?"},
        BadCase{"mach = 2\n[[space]]\norder = 1", 6, "space must be a table"},
        BadCase{"mach = 2\n[space]\nflux = \"reo\"", 7,
                "must be \"roe\" | \"van_leer\" | \"hllc\", not \"reo\"; did you mean \"roe\"?"},
        BadCase{"mach = 2\n[space]\norder = 2.0", 7, "must be an integer from 1 to 2, not 2"},
        BadCase{"mach = 2\n[steady]\nmax_iterations = 99999999999", 7,
                "must be an integer from 1 to 100000000, not 99999999999"},
        BadCase{"mach = 2\n[reference]\nmoment_center = [1, 2]", 7,
                "three numbers [x, y, z] from -1000000000000 to 1000000000000, not an array of 2"},
        BadCase{"mach = 2\n[reference]\nmoment_center = [1, 2, nan]", 7, "reference.moment_center must be"},
        BadCase{"mach = 2\n[output]\nflow = \"yes\"", 7, "must be true or false"},
        BadCase{"mach = 2\n[output]\nfolder = \"\"", 7, "must not be empty"},
        BadCase{"mach = 2\n[output]\nfolder = \"\"\"a\nb\"\"\"", 7, "multi-line text"},
        BadCase{"mach = 2\n[a.b.c.d.e.f.g.h.i.j.k.l.m.n.o.p.q.r]", 6, "too many parts"},
        BadCase{"mach = 2\ngrün = 1", 6, "not ASCII"}, BadCase{"mach = 2.5\"é\"", 5, "a quote in the middle"},
        BadCase{"mach = 2\n[space]\nflux = \"roe\a\"", 7, "a control character"},
        BadCase{"mach = 2\n[motion]\nkind = \"table\"\n[unsteady]\nduration = 1\nsteps = 2", 7,
                "needs motion.table_file"},
        BadCase{"mach = 2\n[motion]\nkind = \"step_alpha\"\n[unsteady]\nsteps = 20", 7,
                "needs unsteady.duration > 0"},
        BadCase{"mach = 2\n[motion]\nkind = \"pitch\"\n[unsteady]\ncycles = 1.25", 9,
                "set unsteady.cycles = 1.5"},
        BadCase{"mach = 2\n[motion]\nkind = \"plunge\"\n[unsteady]\nsteps_per_cycle = 12", 9,
                "set unsteady.steps_per_cycle = 13 or more"},
        BadCase{"mach = 2\n[motion]\nkind = \"plunge\"\n[unsteady]\ncycles = 1e6\nsteps_per_cycle = 1000", 9,
                "unsteady.cycles * unsteady.steps_per_cycle is 1e+09 time steps; ask for at most 100000000"},
        BadCase{"mach = 2\nbeta = 1\n[reference]\nmodel = \"half\"", 6, "a half model has no sideslip"},
        BadCase{"mach = 2\n[steady]\ncfl_start = 10\ncfl_max = 5", 8, "cfl_max is below"}));

TEST(CaseFile, AStepThatLacksTwoThingsIsToldOfEachOnce) {
  const auto problems = problems_of(minimal + "[motion]\nkind = \"step_alpha\"\n", {});
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_NE(problems[0].what.find("needs unsteady.duration > 0"), std::string::npos);
  EXPECT_NE(problems[1].what.find("unsteady.steps = 0 gives no derivatives"), std::string::npos);
}

TEST(CaseFile, MeshIsAFileOrMadeFromADescription) {
  const std::string rest = "[freestream]\nmach = 2.5\n[boundary]\nbody = \"wall\"\n";
  const std::string described = "[mesh]\nfrom = \"missile.toml\"\nlevel = \"fine\"\n" + rest;
  const auto here = [](const char* name) { return (std::filesystem::current_path() / "a" / name).string(); };
  const Case made = parse_case(described, "a/case.toml");
  EXPECT_EQ(made.mesh.from, here("missile.toml"));
  EXPECT_EQ(made.mesh.level, Fineness::fine);
  EXPECT_EQ(made.mesh.file, "");
  expect_same(parse_case(resolved_case(made), "b/case.toml"), made);
  // What the command line says is in place of what the file says.
  const Case read = parse_case(described, "a/case.toml", {"mesh.file=x.msh"});
  EXPECT_EQ(read.mesh.file, here("x.msh"));
  EXPECT_EQ(read.mesh.from, "");
  const Case other = parse_case(minimal, "a/case.toml", {"mesh.from=x.stl"});
  EXPECT_EQ(other.mesh.file, "");
  EXPECT_EQ(other.mesh.from, here("x.stl"));
  const auto problems = problems_of("[mesh]\nfile = \"x.msh\"\nfrom = \"missile.toml\"\n" + rest);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].text(),
            "case.toml:3: mesh.from and mesh.file are both given; leave out either of them");
  EXPECT_EQ(problems_of(described, {"mesh.file=x.msh", "mesh.from=x.stl"}).size(), 1u);
}

TEST(CaseFile, AllProblemsComeAtOnceInTheOrderOfTheFile) {
  const auto problems =
      problems_of("[mesh]\nscale = 0\n[freestream]\nmach = -2\n[boundary]\n[space]\nfluxx = 1\n",
                  {"freestream.gamma=1", "nonsense", "space.orde=1"});
  ASSERT_EQ(problems.size(), 8u);
  const std::vector<std::pair<int, std::string>> expected = {{1, "mesh.file is missing"},
                                                             {2, "mesh.scale"},
                                                             {4, "freestream.mach"},
                                                             {5, "[boundary] is missing or empty"},
                                                             {7, "did you mean space.flux?"}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(problems[i].line, expected[i].first);
    EXPECT_NE(problems[i].text().find(expected[i].second), std::string::npos) << problems[i].text();
  }
  std::string overrides;
  for (std::size_t i = 5; i < 8; ++i) overrides += problems[i].text() + "\n";
  EXPECT_NE(overrides.find("--set freestream.gamma=1: freestream.gamma must be"), std::string::npos)
      << overrides;
  EXPECT_NE(overrides.find("--set nonsense: is not of the form key=value"), std::string::npos) << overrides;
  EXPECT_NE(overrides.find("--set space.orde=1: unknown key space.orde; did you mean space.order?"),
            std::string::npos)
      << overrides;
}

TEST(CaseFile, ManyProblemsAreCut) {
  std::string text = minimal + "[space]\n";
  for (int i = 0; i < 2000; ++i) text += "key" + std::to_string(i) + " = 1\n";
  const auto problems = problems_of(text);
  ASSERT_EQ(problems.size(), 51u);
  EXPECT_EQ(problems.back().what, "and 1950 more mistakes");
}

TEST(CaseFile, UnreadableFilesAreRefused) {
  const auto folder = std::filesystem::path(testing::TempDir());
  const auto message = [](const std::string& path) -> std::string {
    try {
      read_case(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("/no/such/case.toml").find("no such case file"), std::string::npos);
  EXPECT_NE(message(folder).find("not a regular file"), std::string::npos);
  const auto empty = folder / "empty_case.toml";
  std::ofstream(empty).close();
  EXPECT_NE(message(empty).find("freestream.mach is missing"), std::string::npos);
  const auto large = folder / "large_case.toml";
  std::ofstream(large) << std::string((1 << 20) + 1, '#');
  EXPECT_NE(message(large).find("too large"), std::string::npos);
  std::filesystem::remove(empty);
  std::filesystem::remove(large);
}

TEST(CaseFile, DeepNestingIsRefused) {
  const auto repeated = [](const std::string& piece, int times) {
    std::string out;
    for (int i = 0; i < times; ++i) out += piece;
    return out;
  };
  EXPECT_FALSE(problems_of("x = " + repeated("[", 100000)).empty());
  EXPECT_FALSE(problems_of("x = " + repeated("{a=", 100000)).empty());
  EXPECT_FALSE(problems_of("[" + repeated("a.", 100000) + "a]").empty());
  EXPECT_FALSE(problems_of(repeated("\"#\" . ", 100000) + "a = 1").empty());
  EXPECT_FALSE(problems_of("x = " + repeated("{a.a.a.a.a.a.a.a = [\n", 20000)).empty());
  EXPECT_FALSE(problems_of(minimal, {"space.order=" + repeated("[", 100000)}).empty());
  EXPECT_FALSE(problems_of(minimal, {repeated("a.", 100000) + "=1"}).empty());
}

/// No block of memory above twice the file and 16 KiB; the pointers of a TOML array would take 16 bytes for
/// two.
TEST(CaseFile, LongFilesStayWithinBoundedMemory) {
  std::string keys, tables, numbers = "x = [", texts;
  for (int i = 0; i < 20'000; ++i) {
    keys += "k" + std::to_string(i) + "=1\n";
    tables += "[[a]]\n";
    numbers += "1,";
    texts += "boundary.b" + std::to_string(i) + " = \"wall\"\n";
  }
  describe_case_keys();  // the keys are made once
  for (const std::string& text :
       {keys, tables, numbers + "]\n", texts, "x = \"" + std::string(100'000, 'y') + "\"\n",
        std::string(100'000, 'k') + " = 1\n", "#" + std::string(100'000, 'c')}) {
    memory.reset();
    EXPECT_FALSE(problems_of(text).empty());
    EXPECT_LE(memory.largest, 2 * text.size() + 16384) << text.substr(0, 20);
  }
}

/// Deterministic mutants of a good file: whatever they say, the answer is a Case or an InputError. 2,000 of
/// them.
TEST(CaseFile, MutantsNeverDoWorseThanAnInputError) {
  const std::string pieces[] = {"[",
                                "]",
                                "{",
                                "}",
                                "\"",
                                "'",
                                "=",
                                ".",
                                ",",
                                "\n",
                                "#",
                                "\\",
                                "\\u0000",
                                "nan",
                                "-inf",
                                "1e999",
                                "9999999999999999999999",
                                "0x",
                                "\xff",
                                std::string(1, '\0'),
                                "\r",
                                "[[a]]",
                                "\"\"\"",
                                "1979-05-27T07:32:00Z",
                                "true",
                                "_",
                                "+",
                                "\xef\xbb\xbf"};
  std::mt19937 random(20240607);
  const auto below = [&](std::size_t limit) { return random() % limit; };
  int accepted = 0;
  for (int mutant = 0; mutant < 2000; ++mutant) {
    std::string text = mutant % 2 ? full : minimal;
    for (std::size_t change = 1 + below(4); change > 0; --change) {
      const std::size_t at = below(text.size());
      switch (below(4)) {
        case 0:
          text[at] = static_cast<char>(random());
          break;
        case 1:
          text.erase(at, 1 + below(8));
          break;
        case 2:
          text.insert(at, pieces[below(std::size(pieces))]);
          break;
        default:
          text.insert(at, text.substr(below(text.size()), 1 + below(40)));
      }
      if (text.empty()) text = "x";
    }
    try {
      const Case c = parse_case(text, "mutant.toml", {text.substr(0, below(text.size()))});
      expect_same(parse_case(resolved_case(c), "again.toml"), c);
      ++accepted;
    } catch (const InputError& error) {
      ASSERT_FALSE(error.problems().empty());
    }
    try {
      const Case c = parse_case(text, "mutant.toml");
      expect_same(parse_case(resolved_case(c), "again.toml"), c);
      ++accepted;
    } catch (const InputError& error) {
      ASSERT_FALSE(error.problems().empty());
    }
  }
  EXPECT_GT(accepted, 20);  // some mutants are harmless: both branches are exercised
}

TEST(Suggestion, DistanceCountsEditsAndSwaps) {
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);  // the textbook example
  EXPECT_EQ(edit_distance("mahc", "mach"), 1);
  EXPECT_EQ(nearest("fluxx", {"order", "flux"}), "flux");
  EXPECT_EQ(nearest("xyzzy", {"order", "flux"}), "");
}

}  // namespace
}  // namespace alphadot
