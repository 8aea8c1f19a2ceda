// Explicit time steps of V dU/dt + R(U) = 0, independent of the implicit drivers.
#pragma once

#include <vector>

#include "space/residual.hpp"
#include "support/box_case.hpp"

namespace alphadot::testing_support {

/// Third-order Runge-Kutta of Shu & Osher (J. Comput. Phys. 77, 1988, equation 2.18), under fixed conditions.
class RungeKutta3 {
 public:
  RungeKutta3(const BoxCase& box, const Conditions<Real>& conditions)
      : box_(box),
        conditions_(conditions),
        residual_(box.discretization, box.comm),
        values_(box.cells()),
        old_(box.cells()) {}

  void advance(FlowField<Real>& flow, Real step) {
    for (std::size_t i = 0; i < old_.size(); ++i) old_[i] = conserved(flow[static_cast<Index>(i)], gamma_air);
    for (const Real share : {1.0, 0.25, 2.0 / 3}) stage(flow, step, share);
  }

 private:
  /// U <- (1 - share) U^n + share (U + dt L(U))
  void stage(FlowField<Real>& flow, Real step, Real share) {
    residual_.evaluate(flow, conditions_, box_.discretization.space().order, values_);
    for (Index cell = 0; cell < box_.domain.owned_cells; ++cell) {
      const auto moved = conserved(flow[cell], gamma_air) - (step / box_.domain.volume[cell]) * values_[cell];
      flow[cell] = primitive((1 - share) * old_[cell] + share * moved, gamma_air);
    }
  }

  const BoxCase& box_;
  Conditions<Real> conditions_;
  Residual residual_;
  std::vector<Conserved<Real>> values_, old_;
};

}  // namespace alphadot::testing_support
