// The first-order residual and its derivative along a direction, by differences of whole evaluations.
#pragma once

#include <vector>

#include "space/residual.hpp"
#include "support/box_case.hpp"

namespace alphadot::testing_support {

/// Step of central differences: truncation step^2 f''' / 6 = 1e-11, round-off 1e-16 / step = 1e-11.
inline constexpr Real difference_step = 1e-5;

/// First-order residual of one flow under fixed conditions. The source of turning axes is taken away: the
/// implicit operators leave it out.
class FirstOrder {
 public:
  FirstOrder(const BoxCase& box, const Conditions<Real>& conditions)
      : box_(box), conditions_(conditions), residual_(box.discretization, box.comm) {}

  std::vector<Conserved<Real>> at(FlowField<Real>& flow) {
    std::vector<Conserved<Real>> out(box_.cells());
    residual_.evaluate(flow, conditions_, 1, out);
    for (Index cell = 0; cell < box_.domain.owned_cells; ++cell) {
      const Real mass = box_.domain.volume[cell] * flow[cell][0];
      const Vec3 source = mass * cross(conditions_.grid.rotation, velocity(flow[cell]));
      for (int i = 0; i < 3; ++i) out[cell][i + 1] -= source[i];
    }
    return out;
  }

  /// dR/dW . direction about `flow`. Both are [owned_cells]; `flow` ends up as it was, but for round-off.
  std::vector<Conserved<Real>> derivative(FlowField<Real>& flow,
                                          const std::vector<Primitive<Real>>& direction,
                                          Real step = difference_step) {
    const auto shift = [&](Real by) {
      for (std::size_t i = 0; i < direction.size(); ++i) flow[static_cast<Index>(i)] += by * direction[i];
    };
    shift(step);
    auto out = at(flow);
    shift(-2 * step);
    const auto below = at(flow);
    shift(step);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = (0.5 / step) * (out[i] - below[i]);
    return out;
  }

 private:
  const BoxCase& box_;
  Conditions<Real> conditions_;
  Residual residual_;
};

/// Derivative of the conserved state along a change of the primitive one, by the product rule.
inline Conserved<Real> conserved_change(const Primitive<Real>& w, const Primitive<Real>& dw) {
  const Vec3 u = velocity(w), du = velocity(dw);
  const Vec3 m = dw[0] * u + w[0] * du;
  return {{dw[0], m.x, m.y, m.z, dw[4] / (gamma_air - 1) + 0.5 * dw[0] * dot(u, u) + w[0] * dot(u, du)}};
}

}  // namespace alphadot::testing_support
