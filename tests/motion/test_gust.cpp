// Shapes of gusts. Expectations: their definitions, and means by the midpoint rule.
#include "motion/gust.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"

namespace alphadot {
namespace {

Gust gust_of(GustKind kind, GustTable table = {}) {
  GustSettings settings;
  settings.kind = kind;
  settings.velocity = 0.02;
  settings.length = 3;
  return Gust(settings, 2, std::move(table));
}

TEST(Gust, HasItsShape) {
  constexpr Real top = 2 * 0.02;
  for (const Real x : {-1.0, 0.4, 1.5, 2.9, 7.0}) {
    const Real inside = x > 0 ? 1 : 0;
    EXPECT_NEAR(gust_of(GustKind::sharp).velocity(x), inside * top, 1e-12) << x;
    EXPECT_NEAR(gust_of(GustKind::harmonic).velocity(x), inside * top * std::sin(2 * pi * x / 3), 1e-8) << x;
    EXPECT_NEAR(gust_of(GustKind::one_minus_cosine).velocity(x),
                x > 0 && x < 3 ? top * 0.5 * (1 - std::cos(2 * pi * x / 3)) : 0, 1e-8)
        << x;
  }
  const auto table = parse_gust_table("distance, velocity\n0 0.01\n2 0.03\n4 0\n", "gust.txt");
  const Real expected[][2] = {{-0.5, 0}, {1, 0.04}, {3, 0.03}, {9, 0}};
  for (const auto& [x, w] : expected) EXPECT_NEAR(gust_of(GustKind::table, table).velocity(x), w, 1e-6) << x;
}

TEST(Gust, IsAveragedOverAnInterval) {
  const auto table = parse_gust_table("distance velocity\n0 0\n1 0.5\n2.5 -0.3\n", "gust.txt");
  constexpr Real half = 0.4;
  constexpr int parts = 4000;
  for (const auto kind : {GustKind::sharp, GustKind::one_minus_cosine, GustKind::harmonic, GustKind::table})
    for (const Real x : {-0.1, 0.3, 1.2, 2.6, 30.0}) {
      const auto gust = gust_of(kind, table);
      Real sum = 0;
      for (int i = 0; i < parts; ++i) sum += gust.velocity(x - half + 2 * half * (i + 0.5) / parts);
      EXPECT_NEAR(gust.mean(x, half), sum / parts, 1e-4) << word_of(kind) << " " << x;
    }
}

TEST(GustTable, SaysWhatIsWrong) {
  const auto expect = [](const std::string& text, int line, const std::string& what) {
    try {
      parse_gust_table(text, "gust.txt");
      ADD_FAILURE() << "accepted: " << text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.problems().front().line, line) << text;
      EXPECT_NE(error.problems().front().what.find(what), std::string::npos) << error.what();
    }
  };
  expect("", 0, "empty");
  expect("distance\n0\n1\n", 0, "no column velocity");
  expect("velocity\n0\n1\n", 0, "no column distance");
  expect("distance speed\n0 0\n", 1, "not a column of a gust");
  expect("distance velocity\n1 0\n2 0\n", 2, "does not start at 0");
  expect("distance velocity\n0 0\n0 1\n", 3, "does not increase");
  expect("distance velocity\n0 0\n", 0, "fewer than two");
}

}  // namespace
}  // namespace alphadot
