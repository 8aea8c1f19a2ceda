// The numerical flux that a case asks for.
#pragma once

#include "euler/hllc.hpp"
#include "euler/kinds.hpp"
#include "euler/roe.hpp"
#include "euler/van_leer.hpp"

namespace alphadot {

/// Gas and flux parameters, the same for every face.
struct FluxModel {
  FluxKind kind = FluxKind::roe;
  Real gamma = 1.4;
  Real entropy_fix = 0.1;
};

/// Numerical flux per unit area through a face whose unit normal points from left to right and which moves
/// with normal speed `grid_speed`.
template <class T>
inline Conserved<T> numerical_flux(const FluxModel& model, const Primitive<T>& left,
                                   const Primitive<T>& right, const Vec3& normal, const T& grid_speed) {
  switch (model.kind) {
    case FluxKind::van_leer:
      return van_leer_flux(left, right, normal, grid_speed, model.gamma);
    case FluxKind::hllc:
      return hllc_flux(left, right, normal, grid_speed, model.gamma);
    case FluxKind::roe:
      break;
  }
  return roe_flux(left, right, normal, grid_speed, model.gamma, model.entropy_fix);
}

}  // namespace alphadot
