#include "analysis/derivatives.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/error.hpp"

namespace alphadot {

std::string_view name(Variable variable) {
  constexpr std::array<std::string_view, 11> names = {
      "alpha",           "beta",           "p", "q", "r", "alphadot", "betadot", "alphaddot", "betaddot",
      "q_plus_alphadot", "r_minus_betadot"};
  return names[static_cast<std::size_t>(variable)];
}

std::string derivative_name(std::string_view coefficient, Variable variable) {
  return fmt::format("{}_{}", coefficient, name(variable));
}

namespace {

const CoefficientsOf<Estimate>& column(const DerivativeSet& set, Variable variable,
                                       std::string_view purpose) {
  const auto found = set.find(variable);
  if (found == set.end())
    throw InputError("", 0,
                     fmt::format("the derivatives with respect to {} are missing: they are needed for {}",
                                 name(variable), purpose),
                     "compute them in the same run");
  return found->second;
}

}  // namespace

void EstimatedDerivatives::add(std::string source, DerivativeSetOf<Real> share) {
  for (auto& [variable, column] : derivatives)
    for (int i = 0; i < column.size(); ++i) column[i].uncertainty += share.at(variable)[i];
  parts.push_back({std::move(source), std::move(share)});
}

DerivativeSet moment_transfer(const DerivativeSet& about_old, Real dx) {
  constexpr std::string_view purpose = "moving the axis of rotation";
  DerivativeSet moved = about_old;
  for (auto& [variable, values] : moved) {
    if (variable == Variable::q || variable == Variable::q_plus_alphadot)
      values += -2 * dx * column(about_old, Variable::alpha, purpose);
    if (variable == Variable::r || variable == Variable::r_minus_betadot)
      values += 2 * dx * column(about_old, Variable::beta, purpose);
    values = moment_transfer(values, Vec3{dx, 0, 0});
  }
  return moved;
}

Real quasi_steady_limit(Real by_angle, Real by_second_rate, Real share) {
  return std::sqrt(share * std::abs(by_angle / by_second_rate));
}

void add_damping_by_subtraction(DerivativeSet& derivatives) {
  constexpr std::string_view purpose = "the damping by subtraction";
  derivatives[Variable::q] = column(derivatives, Variable::q_plus_alphadot, purpose) -
                             column(derivatives, Variable::alphadot, purpose);
}

}  // namespace alphadot
