// One implicit iteration, shared by the steady and the dual-time driver.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/communicator.hpp"
#include "linear/gmres.hpp"
#include "space/forces.hpp"
#include "space/residual.hpp"

namespace alphadot {

/// What one residual evaluation says about the whole flow, the same on every rank.
struct FlowReport {
  Real density_residual = 0;  ///< root of the mean square over all cells of the net mass outflow
  std::vector<Load> loads;    ///< of every patch
  Load total;                 ///< their sum
  /// Where density and pressure are kept positive: cells whose gradients are cut for it, and faces that use
  /// less than the limited gradients.
  GlobalIndex positivity_cells = 0, positivity_faces = 0;
  bool physical = true;  ///< every residual is finite
};

/// Numbers of somebody else that travel with the sum of every report, so that it stays the only all-reduce of
/// an iteration: what each rank puts in, and who hears the sums over all ranks.
struct Reduction {
  std::function<std::vector<Real>()> of_this_rank;
  std::function<void(std::span<const Real>)> hear;
};

/// A cell in which the flow goes wrong.
struct SuspectCell {
  GlobalIndex id = 0;  ///< in the order of the mesh file
  Vec3 center;
  Real change = 0;  ///< |net mass outflow| per volume; huge when the residual is not finite
};

/// Unknowns, residual and update of one rank, and the steps of an iteration on them.
class ImplicitIteration {
 public:
  ImplicitIteration(const Discretization& discretization, const Communicator& comm,
                    std::unique_ptr<LinearSolver> solver, const Vec3& moment_center);

  FlowField<Real>& flow() { return flow_; }
  const FlowField<Real>& flow() const { return flow_; }
  const Residual& residual() const { return residual_; }
  /// The implicit scheme, whatever is around it.
  LinearSolver& linear_solver() { return *solver_; }
  const Vec3& moment_center() const { return moment_center_; }
  const Discretization& discretization() const { return discretization_; }
  const Communicator& communicator() const { return comm_; }
  std::span<Conserved<Real>> residual_values() { return values_; }

  void set_uniform(const Primitive<Real>& state);

  /// Holds the limiter's factors of the latest evaluation, or lets them go.
  void freeze_limiter(bool frozen) { residual_.freeze_limiter(frozen); }
  /// Once frozen they are part of what a march depends on.
  bool limiter_is_frozen() const { return residual_.reconstruction().limiter_is_frozen(); }
  std::span<Five<float>> limiter_factors() { return residual_.limiter_factors(); }
  /// Evaluates R(W) into residual_values().
  void evaluate(const Conditions<Real>& conditions, int order);
  /// Norm, loads and flags of the latest evaluation: one all-reduce.
  FlowReport report() const;
  /// Sums `numbers` over all ranks in one all-reduce, which takes that of others along.
  void sum(std::vector<Real>& numbers) const;
  void take_along(Reduction reduction) { reduction_ = std::move(reduction); }
  /// The cells of all ranks in which the latest residual is not finite or else makes the density change most,
  /// worst first. Collective.
  std::vector<SuspectCell> worst_cells(std::size_t count) const;
  /// From now on steps are Newton's, of GMRES around the scheme in at most so many directions; 0: the
  /// scheme's own again.
  void use_krylov(int directions);
  void linearise(const Conditions<Real>& conditions, const TimeTerms& time) {
    stepper().linearise(flow_, conditions, time);
  }
  /// Solves for an update from residual_values() and adds it to the flow, capped cell by cell. Returns the
  /// number of capped cells on this rank.
  Index advance();
  /// Keeps this share of the latest advance().
  void shorten(Real share);
  /// Takes back the latest advance().
  void undo();

  GlobalIndex iterations() const { return iterations_; }
  HaloTraffic halo_traffic() const {
    return flow_.halo().traffic() + residual_.reconstruction().halo().traffic() + solver_->halo_traffic();
  }
  /// Bytes of this rank's arrays, mesh included.
  std::size_t bytes() const;

 private:
  LinearSolver& stepper() { return krylov_ ? static_cast<LinearSolver&>(*krylov_) : *solver_; }

  const Discretization& discretization_;
  const Communicator& comm_;
  std::unique_ptr<LinearSolver> solver_;
  Vec3 moment_center_;
  Reduction reduction_{[] { return std::vector<Real>{}; }, [](auto) {}};
  FlowField<Real> flow_;
  Residual residual_;
  std::unique_ptr<Gmres> krylov_;            // around the scheme, while it is in use
  std::vector<Conserved<Real>> values_;      // [owned_cells]
  std::vector<Primitive<Real>> update_;      // [owned_cells]; after advance(): the flow before it
  std::atomic<GlobalIndex> iterations_ = 0;  // read by the watchdog's thread
};

}  // namespace alphadot
