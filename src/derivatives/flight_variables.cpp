#include "derivatives/flight_variables.hpp"

#include <cmath>

namespace alphadot {

ConditionsChange change_of(Variable variable, const FreestreamSettings& stream) {
  const Real a = stream.alpha * radians_per_degree, b = stream.beta * radians_per_degree;
  const Real speed = stream.mach;
  switch (variable) {
    case Variable::alpha:
      return {{}, -speed * std::cos(b) * Vec3{-std::sin(a), 0, std::cos(a)}, {}};
    case Variable::beta:
      return {{}, speed * Vec3{std::cos(a) * std::sin(b), std::cos(b), std::sin(a) * std::sin(b)}, {}};
    case Variable::p:
      return {{}, {}, {-1, 0, 0}};
    case Variable::q:
      return {{}, {}, {0, 1, 0}};
    case Variable::r:
      return {{}, {}, {0, 0, -1}};
    default:
      return {};
  }
}

Variable angle_of(Variable variable) {
  using enum Variable;
  if (variable == alphadot || variable == alphaddot) return alpha;
  if (variable == betadot || variable == betaddot) return beta;
  return variable;
}

int rates_in(Variable variable) {
  using enum Variable;
  if (variable == alphaddot || variable == betaddot) return 2;
  return variable == alphadot || variable == betadot || is_control_rate(variable) ? 1 : 0;
}

Real rate_scale(Variable variable, const FlightCondition& settings) {
  using enum Variable;
  const bool is_rotation = variable == p || variable == q || variable == r;
  return std::pow(settings.unit_rate(), is_rotation ? 1 : rates_in(variable));
}

}  // namespace alphadot
