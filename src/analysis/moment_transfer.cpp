#include "analysis/moment_transfer.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace alphadot {

namespace {

/// What the wind at the old centre does per unit of a reduced rate about the new one: angles in rad, surge
/// over the speed.
struct WindChange {
  Real alpha = 0, beta = 0, surge = 0;
};

WindChange wind_change(Variable variable, const Vec3& offset) {
  switch (variable) {
    case Variable::p:
      return {-2 * offset.y, -2 * offset.z, 0};
    case Variable::q:
    case Variable::q_plus_alphadot:
      return {-2 * offset.x, 0, 2 * offset.z};
    case Variable::r:
    case Variable::r_minus_betadot:
      return {0, 2 * offset.x, 2 * offset.y};
    default:
      return {};
  }
}

/// Derivatives by an angle that those by `rate` cannot be moved without.
const CoefficientsOf<Estimate>& needed(const DerivativeSet& set, Variable angle, Variable rate) {
  const auto found = set.find(angle);
  if (found == set.end())
    throw InputError("", 0,
                     fmt::format("the derivatives with respect to {} are missing: those with respect to {} "
                                 "cannot be moved to another centre without them",
                                 name(angle), name(rate)),
                     "compute them in the same run");
  return found->second;
}

}  // namespace

DerivativeSet moment_transfer(const DerivativeSet& about_old, const Vec3& offset) {
  DerivativeSet moved;
  for (const auto& [variable, about] : about_old) {
    const auto [alpha, beta, surge] = wind_change(variable, offset);
    if (surge != 0) continue;
    CoefficientsOf<Estimate> values = about;
    if (alpha != 0) values += alpha * needed(about_old, Variable::alpha, variable);
    if (beta != 0) values += beta * needed(about_old, Variable::beta, variable);
    moved[variable] = moment_transfer(values, offset);
  }
  return moved;
}

EstimatedDerivatives moment_transfer(const EstimatedDerivatives& about_old, const Vec3& offset) {
  EstimatedDerivatives moved{moment_transfer(about_old.derivatives, offset), {}, about_old.unconverged};
  for (const auto& [source, half_width] : about_old.parts) {
    DerivativeSet bounds;
    for (const auto& [variable, column] : half_width)
      for (int i = 0; i < column.size(); ++i) bounds[variable][i].uncertainty = column[i];
    auto& part = moved.parts.emplace_back(UncertaintyPart{source, {}});
    for (const auto& [variable, column] : moment_transfer(bounds, offset))
      for (int i = 0; i < column.size(); ++i) part.half_width[variable][i] = column[i].uncertainty;
  }
  for (const auto& [variable, column] : about_old.derivatives) {
    const auto [alpha, beta, surge] = wind_change(variable, offset);
    if ((alpha != 0 && about_old.unconverged.contains(Variable::alpha)) ||
        (beta != 0 && about_old.unconverged.contains(Variable::beta)))
      moved.unconverged.insert(variable);
  }
  return moved;
}

}  // namespace alphadot
