#include "derivatives/balance.hpp"

#include "analysis/static_margin.hpp"

namespace alphadot {

std::vector<TableRow> balance_rows(const FlightCondition& settings, const EstimatedDerivatives& estimated) {
  const auto& alpha = estimated.derivatives.at(Variable::alpha);
  TableRow margin{"static_margin", static_margin(alpha.CN, alpha.Cm), "-Cm_alpha / CN_alpha, in lengths"};
  for (const auto& [source, half_width] : estimated.parts) {
    const auto& of_alpha = half_width.at(Variable::alpha);
    const auto part = static_margin({alpha.CN.value, of_alpha.CN}, {alpha.Cm.value, of_alpha.Cm}).uncertainty;
    margin.parts.emplace_back(source, part);
  }
  const Real length = settings.reference.length;
  TableRow point{"neutral_point_x", length * margin.value, "centre + margin, in units of the mesh",
                 margin.parts};
  point.value.value += settings.reference.moment_center.x;
  for (auto& [source, part] : point.parts) part *= length;
  margin.converged = point.converged = !estimated.unconverged.contains(Variable::alpha);
  margin.group = point.group = Group::longitudinal;
  return {margin, point};
}

std::vector<std::pair<std::string, Real>> longitudinal_of(std::span<const TableRow> balance,
                                                          const DerivativeSet& derivatives) {
  std::vector<std::pair<std::string, Real>> out{{"static_margin", balance[0].value.value},
                                                {"static_margin_uncertainty", balance[0].value.uncertainty},
                                                {"neutral_point_x", balance[1].value.value},
                                                {"neutral_point_uncertainty", balance[1].value.uncertainty}};
  const auto& alpha = derivatives.at(Variable::alpha);
  if (const auto second = derivatives.find(Variable::alphaddot); second != derivatives.end()) {
    constexpr Real share = 0.01;
    out.emplace_back("quasi_steady_k_of_CN",
                     quasi_steady_limit(alpha.CN.value, second->second.CN.value, share));
    out.emplace_back("quasi_steady_k_of_Cm",
                     quasi_steady_limit(alpha.Cm.value, second->second.Cm.value, share));
  }
  return out;
}

}  // namespace alphadot
