// What displacements of the mesh, and their rates, change about a flow that is held.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "march/implicit_iteration.hpp"

namespace alphadot {

/// Changes of equations and loads while every cell keeps its state.
struct HeldFlowChange {
  std::vector<Conserved<Real>> residual;  ///< [owned_cells]
  std::vector<Load> loads;                ///< of every patch, of this rank only
  std::vector<Load> of_faces;             ///< [boundary_faces] of walls; zero elsewhere
};

/// Of R(W) and the loads, with a displacement of all points, [points]: the derivative along it of the
/// discrete equations, area vectors, centroids, volumes, gradients and the limiter included. Central
/// differences of whole residuals on displaced copies of the mesh: the step strains cells by 1e-5, so that
/// truncation is 1e-10 and round-off about 1e-7 of what a cell's faces change. With `limiter_held` its
/// factors are those of the mesh that is not displaced. About the flow of `iteration`. Takes the work and,
/// meanwhile, the memory of those cells that the displacement changes something for. Collective.
HeldFlowChange change_by_displacement(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                                      std::span<const Vec3> displacement, bool limiter_held);

/// Of d(V U)/dt + R(W) and the loads, with a velocity of all points, [points]: faces that sweep, and volumes
/// that grow meanwhile, so that a uniform stream does not feel it. Collective.
HeldFlowChange change_by_velocity(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                                  std::span<const Vec3> velocity);

/// Of R(W) and the loads, with what a change of the walls' turn on a mesh that stays is to them: `walls` by
/// so much of the change, rad or rad per unit time. Central differences with a step of 1e-5. Collective.
HeldFlowChange change_by_turn(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                              const std::function<std::vector<TurnedWall>(Real)>& walls);

}  // namespace alphadot
