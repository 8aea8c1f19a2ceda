// The measure of a linear system's defect: cell by cell, and safe whatever the preconditioner does.
#pragma once

#include <span>
#include <vector>

#include "space/wave_speed.hpp"

namespace alphadot {

/// D of |D (A U + b)|: the defect of every cell as the change of its primitive state while a wave crosses it,
/// (dW/dU) r / (sum over its faces of area times wave speed). A block of five by five a cell and always
/// regular, so that the norm is zero where A U + b is and nowhere else; the size of a cell and the unit of
/// length drop out. 8 bytes a cell.
class CellScaling {
 public:
  /// About `flow`, which must outlive this.
  CellScaling(const Discretization& discretization, const FlowField<Real>& flow,
              const Conditions<Real>& conditions)
      : flow_(flow), gamma_(discretization.gamma()), waves_(wave_speeds(discretization, flow, conditions)) {}

  /// out = D defect, both [owned_cells]; in place if they are one.
  void scale(std::span<const Conserved<Real>> defect, std::span<Primitive<Real>> out) const {
    for (std::size_t cell = 0; cell < waves_.size(); ++cell)
      out[cell] =
          (1 / waves_[cell]) * primitive_change(flow_[static_cast<Index>(cell)], defect[cell], gamma_);
  }
  /// out = D^-1 scaled.
  void unscale(std::span<const Primitive<Real>> scaled, std::span<Conserved<Real>> out) const {
    for (std::size_t cell = 0; cell < waves_.size(); ++cell)
      out[cell] = waves_[cell] * conserved_change(flow_[static_cast<Index>(cell)], scaled[cell], gamma_);
  }
  std::size_t bytes() const { return waves_.size() * sizeof(Real); }

 private:
  const FlowField<Real>& flow_;
  Real gamma_;
  std::vector<Real> waves_;  // [owned_cells]
};

}  // namespace alphadot
