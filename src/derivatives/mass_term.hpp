// What a change in time adds to the linearised residual, and its transpose.
#pragma once

#include <span>

#include "euler/state_change.hpp"
#include "march/implicit_iteration.hpp"

namespace alphadot {

/// image += factor V (dU/dW) w, [owned_cells]: the change of the conserved state that goes with a change w of
/// the primitive one.
inline void add_mass_term(const ImplicitIteration& iteration, Real factor,
                          std::span<const Primitive<Real>> change, std::span<Conserved<Real>> image) {
  const Discretization& discretization = iteration.discretization();
  for (std::size_t cell = 0; cell < image.size(); ++cell)
    image[cell] +=
        factor * discretization.domain().volume[cell] *
        conserved_change(iteration.flow()[static_cast<Index>(cell)], change[cell], discretization.gamma());
}

/// image += V (dU/dW)^T y, [owned_cells].
inline void add_transposed_mass_term(const ImplicitIteration& iteration, std::span<const Conserved<Real>> y,
                                     std::span<Primitive<Real>> image) {
  const Discretization& discretization = iteration.discretization();
  for (std::size_t cell = 0; cell < image.size(); ++cell)
    image[cell] += discretization.domain().volume[cell] *
                   conserved_change_transposed(iteration.flow()[static_cast<Index>(cell)], y[cell],
                                               discretization.gamma());
}

}  // namespace alphadot
