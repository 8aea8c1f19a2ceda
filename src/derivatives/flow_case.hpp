// A case set up for computing: its mesh, its solver and its steady flow, without a command line or files of a
// run.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/panel.hpp"
#include "derivatives/setup.hpp"
#include "march/deflection.hpp"
#include "march/free_flight.hpp"
#include "march/steady.hpp"
#include "march/treatment.hpp"
#include "motion/motion.hpp"

namespace alphadot {

/// A steady residual that has dropped by fewer decades leaves more in derivatives than their linear solves.
inline constexpr Real deep_steady_orders = 6;

/// Where the march to the steady state stands: with the flow, and the limiter's threshold and factors, all
/// that it goes on from.
struct MarchState {
  SteadyState steady;
  std::size_t attempt = 0;  ///< how often it has begun again
};

/// Mesh, solver and steady flow of one case on this rank.
class FlowCase {
 public:
  /// Reads, checks and distributes the mesh of the case. Collective. Throws InputError on every rank.
  FlowCase(const Case& settings, const Communicator& comm) : FlowCase(load_setup(settings, comm), comm) {}
  /// The same with a mesh that has been read. The communicator must outlive the object.
  FlowCase(Setup setup, const Communicator& comm);
  FlowCase(const FlowCase&) = delete;
  FlowCase& operator=(const FlowCase&) = delete;

  const Case& settings() const { return setup_.settings; }
  const Setup& setup() const { return setup_; }
  const Communicator& communicator() const { return comm_; }
  const Discretization& discretization() const { return discretization_; }
  ImplicitIteration& iteration() { return iteration_; }
  const ImplicitIteration& iteration() const { return iteration_; }
  const Motion& motion() const { return motion_; }
  /// How the mesh, as it is in the steady flow, follows each control of the case, in their order.
  const std::vector<Deflection>& control_deflections() const { return control_deflections_; }

  /// Of the steady flow.
  Conditions<Real> conditions() const;
  /// The case's way to let the motion enter the equations; moves this case's mesh. Collective.
  std::unique_ptr<Treatment> treatment(Real time_step);
  /// Of a body released from the steady flow.
  std::unique_ptr<FreeFlight> free_flight(Real time_step) const;

  /// Asked after every iteration; false ends the march.
  using Observer = std::function<bool(const SteadyProgress&)>;
  /// Marches to the steady state, from the free stream or where go_on_from() has put it. Begins again where
  /// it loses its way, with gentler steps, and where it stalls, once, with a limiter that lets less pass; the
  /// iterations then count from one. Status converged; unconverged, with shortfall(); or interrupted. Throws
  /// DivergedError. Collective.
  RunStatus march(const Observer& observer = {});
  const MarchState& march_state() const { return march_; }
  /// The march goes on from here; flow and limiter are the caller's to put in place.
  void go_on_from(const MarchState& state) {
    march_ = state;
    goes_on_ = true;
  }
  void set_limiter_threshold(Real threshold) { discretization_.set_limiter_threshold(threshold); }

  /// Of the steady flow, the same on every rank.
  const FlowReport& steady_report() const { return steady_report_; }
  /// In place of march(): the loads of a steady flow, [patches], that this case's motion began from.
  void set_steady_loads(std::vector<Load> loads);
  /// Decades that the residual of the steady flow has dropped, with the limiter free.
  Real steady_orders() const { return steady_orders_; }
  /// What the march has changed about the case; empty: nothing.
  const std::string& remark() const { return remark_; }
  /// What the march did not reach, if it fell short.
  const std::optional<std::string>& shortfall() const { return shortfall_; }

 private:
  std::unique_ptr<GustField> gust() const;
  void make_lee_dissipative();
  void deflect_controls();

  Setup setup_;
  const Communicator& comm_;
  Discretization discretization_;
  std::vector<Deflection> control_deflections_;
  Motion motion_;
  ImplicitIteration iteration_;
  MarchState march_;
  bool goes_on_ = false;
  FlowReport steady_report_;
  Real steady_orders_ = 0;
  std::string remark_;
  std::optional<std::string> shortfall_;
};

/// Patches that a control turns: its own, and the faces that mesh.aft_jets parts from them.
std::vector<std::string> turning_patches(const ControlSettings& control, const MeshSettings& mesh);

/// Of a control by its settings.
Hinge hinge_of(const ControlSettings& control);
PanelFrame frame_of(const ControlSettings& control);  ///< of its panel

/// "cell 7 at (1, 2, 3), cell 8 at ...": the first few.
std::string named(std::span<const SuspectCell> cells);

}  // namespace alphadot
