// Coefficients as functionals of the walls' loads. The expected number is the definition: what a coefficient
// takes of each entry of a load, summed up, is the coefficient of that load.
#include "derivatives/functional.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "derivatives/adjoint_derivatives.hpp"
#include "derivatives/loads.hpp"

namespace alphadot {
namespace {

constexpr Real round_off = 1e-13;

FlightCondition flight(bool half_model) {
  FlightCondition out;
  out.reference = {.length = 0.7, .area = 0.3, .moment_center = {1, 2, 3}, .half_model = half_model};
  out.freestream.mach = 1.8;
  return out;
}
const std::vector<std::string> patches{"body", "fin", "farfield"};
const std::vector<Load> loads{{{1, -2, 3}, {0.5, 7, -1}}, {{-4, 0.3, 2}, {1, -0.2, 5}}, {}};

Real product(const std::vector<Load>& weights) {
  Real sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    sum += dot(weights[i].force, loads[i].force) + dot(weights[i].moment, loads[i].moment);
  return sum;
}

class FunctionalTest : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Models, FunctionalTest, testing::Bool());

TEST_P(FunctionalTest, WeighsLoadsAsTheCoefficientsDo) {
  const FlightCondition settings = flight(GetParam());
  const auto whole = coefficients(total_of(loads), settings), fin = coefficients(loads[1], settings);
  for (int i = 0; i < Coefficients::size(); ++i) {
    EXPECT_NEAR(product(weights_of({i}, patches, settings)), whole[i], round_off);
    EXPECT_NEAR(product(weights_of({i, {"fin"}}, patches, settings)), fin[i], round_off);
  }
}

// Symmetry leaves CA, CN and Cm of a half model, and all six of a full one.
TEST_P(FunctionalTest, LeavesOutWhatSymmetryMakesZero) {
  std::vector<std::string> names;
  for (const auto& functional : all_functionals(flight(GetParam()))) names.push_back(functional.name());
  const std::vector<std::string> half{"CA", "CN", "Cm"}, full{"CA", "CY", "CN", "Cl", "Cm", "Cn"};
  EXPECT_EQ(names, GetParam() ? half : full);
}

// A set stands for its walls, beside which none may be named again.
TEST(Functional, TakesWallsAndSetsOfWalls) {
  const Components components{{"fin_1", {"fin_1"}}, {"fin_2", {"fin_2"}},         {"body", {"body"}},
                              {"a+b", {"a+b"}},     {"tail", {"fin_1", "fin_2"}}, {"sum", {"a+b"}}};
  const auto name = [&](const char* text) {
    return parse_functional(text, "--of", flight(true), components).name();
  };
  EXPECT_EQ(name("CN@tail"), "CN@fin_1+fin_2");
  EXPECT_EQ(name("Cm_alphadot@body+tail"), "Cm_alphadot@body+fin_1+fin_2");
  EXPECT_EQ(name("CN@sum"), "CN@a+b");
  EXPECT_THROW(name("CN@tail+fin_1"), InputError);
  EXPECT_THROW(name("CN@nose"), InputError);
}

}  // namespace
}  // namespace alphadot
