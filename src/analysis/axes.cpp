#include "analysis/axes.hpp"

#include "core/error.hpp"

namespace alphadot {

DerivativeSet to_stability_axes(const DerivativeSet& body, const Coefficients& steady, Real alpha) {
  DerivativeSet out;
  for (const auto& [variable, values] : body) out[variable] = to_stability_axes(values, alpha);

  if (const auto column = out.find(Variable::alpha); column != out.end()) {
    const Coefficients turned = to_stability_axes(steady, alpha);  // CA is CD, CN is CL
    column->second.CA.value += turned.CN;
    column->second.CN.value -= turned.CA;
    column->second.Cl.value += turned.Cn;
    column->second.Cn.value -= turned.Cl;
  }
  if (body.contains(Variable::p) != body.contains(Variable::r) && alpha != 0)
    throw InputError("", 0, "stability axes: derivatives with respect to one of p and r are missing",
                     "compute both, or use body axes");
  if (body.contains(Variable::p) && body.contains(Variable::r)) {
    // p = p' cos - r' sin, r = p' sin + r' cos.
    const auto p = out[Variable::p], r = out[Variable::r];
    const Real c = std::cos(alpha), s = std::sin(alpha);
    out[Variable::p] = c * p + s * r;
    out[Variable::r] = c * r + -s * p;
  }
  return out;
}

}  // namespace alphadot
