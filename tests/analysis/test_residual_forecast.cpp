#include "analysis/residual_forecast.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace alphadot {
namespace {

// A quarter of a decade in each iteration of two seconds: the six that are missing of ten take 48 s.
TEST(ResidualForecast, SteadyFall) {
  ResidualForecast forecast;
  for (int i = 0; i <= 16; ++i) {
    forecast.add(2 * i, 0.25 * i);
    EXPECT_TRUE(std::isnan(forecast.seconds_to(10))) << "too early";
  }
  for (int i = 17; i <= 24; ++i) forecast.add(2 * i, 0.25 * i);
  EXPECT_NEAR(forecast.seconds_to(10), 2 * (10 - 6) / 0.25, 1e-9);
  EXPECT_EQ(forecast.seconds_to(5), 0);
}

// A march that cycles between 2.7 and 2.8 decades has no end that could be known, nor has one that rises or
// one that slows down.
TEST(ResidualForecast, NothingIsSaidOfAnythingElse) {
  ResidualForecast cycling, rising, slowing;
  for (int i = 0; i < 100; ++i) {
    cycling.add(i, 2.75 + 0.05 * std::cos(pi * i));
    rising.add(i, 4 - 0.01 * i);
    slowing.add(i, 4 - 4 * std::exp(-0.1 * i));
    for (const auto* forecast : {&cycling, &rising, &slowing})
      EXPECT_TRUE(std::isnan(forecast->seconds_to(10))) << i;
  }
}

}  // namespace
}  // namespace alphadot
