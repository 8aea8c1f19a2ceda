// Which derivatives mirrors make zero, beside what parity says of forces (polar) and moments (axial), written
// out.
#include "derivatives/flow_symmetry.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace alphadot {
namespace {

using enum Variable;

Configuration of_size(Real wall_area, Real body_length) {
  Configuration out;
  out.wall_area = wall_area;
  out.body_length = body_length;
  return out;
}

std::set<std::string> zeros(const FlowSymmetry& symmetry, Variable variable) {
  std::set<std::string> out;
  for (int i = 0; i < Coefficients::size(); ++i)
    if (symmetry.makes_zero(i, variable)) out.emplace(coefficient_names[static_cast<std::size_t>(i)]);
  return out;
}

using Names = std::set<std::string>;

TEST(FlowSymmetry, OfABodyAlongTheStream) {
  const FlowSymmetry full({.CA = 0.1}, of_size(50, 10), false), half({.CA = 0.1}, of_size(50, 10), true);
  EXPECT_TRUE(full.is_any());
  for (const auto variable : {alpha, q, alphadot, alphaddot})
    EXPECT_EQ(zeros(full, variable), (Names{"CA", "CY", "Cl", "Cn"}));
  for (const auto variable : {beta, r, betadot, betaddot})
    EXPECT_EQ(zeros(full, variable), (Names{"CA", "CN", "Cl", "Cm"}));
  EXPECT_EQ(zeros(full, p), (Names{"CA", "CY", "CN", "Cm", "Cn"}));
  EXPECT_EQ(zeros(half, alpha), (Names{"CA", "CY", "Cn"}));
  EXPECT_EQ(zeros(full, control_variable("flow_symmetry_flap")), Names{});
}

TEST(FlowSymmetry, AtIncidenceAndInSideslip) {
  const FlowSymmetry up({.CA = 0.1, .CN = 0.2, .Cm = -0.3}, of_size(50, 10), false);
  EXPECT_EQ(zeros(up, alpha), (Names{"CY", "Cl", "Cn"}));
  EXPECT_EQ(zeros(up, p), (Names{"CA", "CN", "Cm"}));
  EXPECT_FALSE(FlowSymmetry({.CA = 0.1, .CN = 0.2}, of_size(50, 10), true).is_any());
  EXPECT_FALSE(FlowSymmetry({.CY = 0.2, .CN = 0.2}, of_size(50, 10), false).is_any());
  EXPECT_FALSE(FlowSymmetry({.Cl = 0.01}, of_size(50, 10), false).is_any());  // canted fins
}

/// A millionth of what a dynamic pressure on all walls makes is nothing.
TEST(FlowSymmetry, WhatCountsAsNothing) {
  EXPECT_TRUE(FlowSymmetry({.CN = 4e-5}, of_size(50, 10), true).is_any());
  EXPECT_FALSE(FlowSymmetry({.CN = 6e-5}, of_size(50, 10), true).is_any());
  EXPECT_TRUE(FlowSymmetry({.Cm = 4e-4}, of_size(50, 10), true).is_any());
}

}  // namespace
}  // namespace alphadot
