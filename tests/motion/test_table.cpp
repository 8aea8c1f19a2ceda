// Motions by table. Expectations: polynomials that the interpolation must reproduce, its order on a sine, and
// one error for each thing that can be wrong with a file.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/error.hpp"
#include "motion/motion.hpp"
#include "support/counted_memory.hpp"
#include "support/mutants.hpp"

namespace alphadot {
namespace {

using testing_support::memory;

// Slopes from parabolas: a quadratic is reproduced wherever its points are.
TEST(Curve, ReproducesAQuadratic) {
  const auto y = [](Real x) { return 3 - 2 * x + 0.5 * x * x; };
  std::vector<Real> xs{0, 0.3, 1, 1.1, 2.5}, ys;
  for (const Real x : xs) ys.push_back(y(x));
  const Curve curve(xs, ys);
  for (Real x = 0.01; x < 2.5; x += 0.07) {
    EXPECT_NEAR(curve.value(x), y(x), 1e-14);
    EXPECT_NEAR(curve.rate(x), -2 + x, 1e-13);
  }
}

TEST(Curve, JoinsTwoPointsByALineAndIsLevelOutside) {
  const Curve curve({0, 2}, {1, 5});
  EXPECT_NEAR(curve.value(0.5), 2, 1e-15);
  EXPECT_NEAR(curve.rate(0.5), 2, 1e-15);
  EXPECT_EQ(curve.value(-1), 1);
  EXPECT_EQ(curve.value(3), 5);
  EXPECT_EQ(curve.rate(-1), 0);
  EXPECT_EQ(curve.rate(3), 0);
}

// Third order: halving the spacing divides the error by eight, of which a sixth is allowed for higher terms.
TEST(Curve, IsOfThirdOrderOnASine) {
  const auto error = [](int n) {
    std::vector<Real> xs, ys;
    for (int i = 0; i <= n; ++i) {
      xs.push_back(2 * pi * i / n);
      ys.push_back(std::sin(xs.back()));
    }
    const Curve curve(xs, ys);
    Real worst = 0;
    for (Real x = 0; x < 6.28; x += 0.003) worst = std::max(worst, std::abs(curve.value(x) - std::sin(x)));
    return worst;
  };
  EXPECT_GT(error(40) / error(80), 6.5);
}

/// The problem that a text is refused with.
Problem problem_of(const std::string& text) {
  try {
    parse_motion_table(text, "motion.csv");
  } catch (const InputError& error) {
    return error.problems().front();
  }
  ADD_FAILURE() << "accepted: " << text;
  return {};
}

TEST(MotionTable, ReadsBlanksCommasAndRemarks) {
  const auto table = parse_motion_table(
      "# a pull-up\n\nt_star, theta alpha\r\n0 , 0 1\n 2.5  2 1.5e0 # half way\n5,4,2\n", "motion.csv");
  EXPECT_EQ(table.end, 5);
  ASSERT_TRUE(table.theta && table.alpha);
  EXPECT_FALSE(table.has_position());
  EXPECT_NEAR(table.theta->value(2.5), 2 * radians_per_degree, 1e-16);
  EXPECT_NEAR(table.alpha->value(5), 2 * radians_per_degree, 1e-16);
}

TEST(MotionTable, NamesFileAndLineOfWhatIsWrong) {
  const auto expect = [](const std::string& text, int line, const std::string& part) {
    const Problem problem = problem_of(text);
    EXPECT_EQ(problem.file, "motion.csv") << text;
    EXPECT_EQ(problem.line, line) << text;
    EXPECT_NE(problem.what.find(part), std::string::npos) << problem.what;
    EXPECT_FALSE(problem.remedy.empty()) << text;
  };
  expect("", 0, "empty");
  expect("# nothing\n", 0, "empty");
  expect("t_star gamma\n", 1, "gamma");
  expect("t_star z z\n", 1, "twice");
  expect("z\n0\n1\n", 0, "t_star");
  expect("t_star z\n0 0\n", 0, "fewer than two");
  expect("t_star z\n0 0\n1\n", 3, "1 numbers for 2 columns");
  expect("t_star z\n0 0\n1 up\n", 3, "not a number");
  expect("t_star z\n0 0\n1 nan\n", 3, "not a number");
  expect("t_star z\n0 0\n1 1e999\n", 3, "not a number");
  expect("t_star z\n0.5 0\n1 1\n", 2, "start at 0");
  expect("t_star z\n0 0\n\n1 1\n1 2\n", 5, "increase");
  expect("t_star z alpha\n0 0 0\n1 1 1\n", 0, "both alpha and a position");
}

/// Whatever is in a file: a table or an InputError, and no block of memory above twice the file and 16 KiB.
TEST(MotionTable, MutantsNeverDoWorseThanAnInputError) {
  const std::string sound =
      "# a pull-up\nt_star, theta x y z\n0 0 0 0 0\n2.5, 1, 0, 0, 0 # half way\n5 4 0.1 0 -2e-1\n";
  testing_support::Random random(20240607);
  int read = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::string text = testing_support::mutant(sound, random);
    memory.reset();
    try {
      EXPECT_GT(parse_motion_table(text, "motion.csv").end, 0) << text;
      ++read;
    } catch (const InputError& error) {
      EXPECT_FALSE(error.problems().empty());
    }
    EXPECT_LE(memory.largest, 2 * text.size() + 16384) << text;
  }
  EXPECT_GT(read, 20);
  EXPECT_LT(read, 1500);
}

TEST(MotionTable, ShortRowsStayWithinBoundedMemory) {
  std::string rows = "t_star\n", empty = "t_star z alpha\n" + std::string(100'000, '\n');
  for (int i = 0; i < 9'000; ++i) rows += std::to_string(i) + "\n";
  for (const auto& text : {rows, empty}) {
    memory.reset();
    try {
      EXPECT_EQ(parse_motion_table(text, "motion.csv").end, 8'999);
    } catch (const InputError& error) {
      EXPECT_EQ(&text == &rows, false) << error.what();
    }
    EXPECT_LE(memory.largest, 2 * text.size() + 16384);
  }
}

// A table of a pitch is the pitch; of a plunge's alpha, the plunge.
TEST(MotionTable, RepeatsHarmonicMotions) {
  constexpr Real k = 0.05;
  const FreestreamSettings stream{.mach = 1.58, .alpha = 2, .beta = 0, .gamma = 1.4};
  for (const bool pitch : {true, false}) {
    MotionSettings settings;
    settings.kind = pitch ? MotionKind::pitch : MotionKind::plunge;
    settings.amplitude = 1.5;
    settings.reduced_frequency = k;
    const Motion expected(settings, stream, 0.7);
    std::string text = pitch ? "t_star theta\n" : "t_star alpha\n";
    for (int i = 0; i <= 200; ++i)
      text += std::to_string(i) + " " + std::to_string((pitch ? 0 : 2) + 1.5 * std::sin(k * i)) + "\n";
    settings.kind = MotionKind::table;
    const Motion found(settings, stream, 0.7, 200, parse_motion_table(text, "motion.csv"));
    for (Real t_star = 0.3; t_star < 199; t_star += 7.7) {
      const Real time = expected.time_of(t_star);
      const Attitude a = expected.at(time), b = found.at(time);
      EXPECT_NEAR(a.alpha, b.alpha, 1e-6);  // six digits in degrees, and third order in k
      EXPECT_NEAR(norm(a.angle - b.angle), 0, 1e-6);
      EXPECT_NEAR(norm(a.velocity - b.velocity), 0, 2e-6);
      EXPECT_NEAR(norm(a.rotation - b.rotation), 0, 1e-5);
    }
  }
}

// A body that climbs at a hundredth of its speed meets the air from above.
TEST(MotionTable, TurnsAPositionIntoIncidence) {
  MotionSettings settings;
  settings.kind = MotionKind::table;
  const Motion motion(settings, {.mach = 2, .alpha = 0, .beta = 0, .gamma = 1.4}, 0.5, 10,
                      parse_motion_table("t_star z\n0 0\n10 0.025\n", "motion.csv"));
  const Attitude now = motion.at(motion.time_of(4));
  EXPECT_NEAR(now.velocity.z, 0.02, 1e-15);  // 0.025 in a time of 10 * 0.5 / (2 * 2)
  EXPECT_NEAR(now.alpha, -std::atan(0.01), 1e-15);
}

}  // namespace
}  // namespace alphadot
