#include "derivatives/flow_case.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "core/log.hpp"
#include "derivatives/loads.hpp"
#include "linear/block_lu_sgs.hpp"
#include "linear/lu_sgs.hpp"
#include "march/turning.hpp"
#include "partition/aft_faces.hpp"
#include "space/lee_cells.hpp"

namespace alphadot {

namespace {

std::unique_ptr<LinearSolver> make_linear_solver(const Discretization& discretization,
                                                 const Communicator& comm, const SteadySettings& settings,
                                                 PassOrder order) {
  if (settings.scheme == SchemeKind::lu_sgs) return std::make_unique<LuSgs>(discretization, comm);
  return std::make_unique<BlockLuSgs>(discretization, comm, settings.sweeps, order);
}

/// Limits of the CFL number for flows that bold steps drive into vacuum. A march that begins again keeps to
/// the first until the flow has taken shape (blunt noses, strong shocks), then to the others all along (high
/// incidence). With the last one the scheme is nearly an explicit one: it comes to rest slowly, and follows
/// flow that is not steady at all.
constexpr Real early_limit = 8;
constexpr std::array gentle_limits{30.0, 4.0};
constexpr std::size_t most_attempts = 1 + gentle_limits.size();

/// Share of the limiter's threshold with which a march that stalls begins again, once: the wake of a base has
/// no steady state until it is damped enough. Not where so many decades are reached.
constexpr Real damped_share = 0.25, well_converged = 6;

/// Of a march that begins again for the so manieth time.
Real early_cfl_max(std::size_t attempt) {
  return attempt == 1 ? early_limit : unlimited;
}
SteadySettings gentler(SteadySettings settings, std::size_t attempt) {
  if (attempt == 0) return settings;
  const Real limit = attempt == 1 ? early_limit : gentle_limits.at(std::min(attempt, most_attempts) - 2);
  settings.cfl_start = std::min(settings.cfl_start / 10, limit);
  settings.cfl_growth = std::pow(settings.cfl_growth, 0.4);
  if (attempt > 1) settings.cfl_max = std::min(settings.cfl_max, limit);
  return settings;
}

constexpr std::size_t named_cells = 3;

/// What a march that ended so did not reach; nothing when it did.
std::optional<std::string> shortfall_of(const SteadyResult& result, const FlowCase& flow) {
  if (result.status != RunStatus::completed && result.status != RunStatus::unconverged) return std::nullopt;
  auto text = fmt::format("the steady residual dropped {:.1f} of {:g} decades in {} iterations",
                          result.orders, flow.settings().steady.orders, result.iterations);
  if (result.has_stalled)
    text += fmt::format(" and falls no more, meanwhile CN goes to and fro by {:.1e}, Cm by {:.1e}",
                        coefficients(result.swing, flow.settings()).CN,
                        std::abs(coefficients(result.swing, flow.settings()).Cm));
  return text + ", worst: " + named(flow.iteration().worst_cells(named_cells));
}

std::vector<Deflection> deflections_of_controls(const FlowCase& flow) {
  std::vector<Deflection> out;
  for (const auto& control : flow.settings().controls)
    out.push_back(deflection(flow.discretization(), turning_patches(control, flow.settings().mesh),
                             hinge_of(control), flow.communicator()));
  return out;
}

/// Walls in a plane of symmetry cannot turn; where they meet others that stay they are held.
void check_control(const ControlSettings& control, const Deflection& deflection, const FlowCase& flow) {
  constexpr Real negligible = 1e-6, much = 0.3;
  const Real at_walls = deflection.lost_at_walls;
  if (deflection.lost_at_symmetry > negligible)
    throw InputError(flow.settings().file, 0,
                     fmt::format("control {} turns walls out of the plane of symmetry", control.name),
                     "use a full model, or a hinge across that plane");
  if (deflection.hinge_distance > 1)
    spdlog::warn(
        "control {}: its hinge is {:.2g} times as far from its walls as they are large; its point is in the "
        "units of [reference], after mesh.scale",
        control.name, deflection.hinge_distance);
  if (at_walls > much && flow.settings().space.deflection == DeflectionKind::mesh)
    spdlog::warn(
        "control {}: where its walls meet others that stay they lose up to {:.0f} % of their displacement; "
        "name all patches of what turns, and mesh a gap where it has one",
        control.name, 100 * at_walls);
}

}  // namespace

std::string named(std::span<const SuspectCell> cells) {
  std::vector<std::string> out;
  for (const auto& [id, at, change] : cells.first(std::min(cells.size(), named_cells)))
    out.push_back(fmt::format("cell {} at ({:.5g}, {:.5g}, {:.5g})", id, at.x, at.y, at.z));
  return fmt::format("{}", fmt::join(out, ", "));
}

FlowCase::FlowCase(Setup setup, const Communicator& comm)
    : setup_(std::move(setup)),
      comm_(comm),
      discretization_(setup_.domain, setup_.patch_kinds, setup_.settings.space,
                      setup_.settings.freestream.gamma),
      motion_(setup_.settings.motion, setup_.settings.freestream, setup_.settings.reference.length,
              setup_.settings.unsteady.duration, setup_.motion_table),
      iteration_(
          discretization_, comm,
          make_linear_solver(discretization_, comm, setup_.settings.steady, pass_order(motion_.wind().x)),
          setup_.settings.reference.moment_center) {
  make_lee_dissipative();
  deflect_controls();
}

void FlowCase::make_lee_dissipative() {
  if (!settings().space.dissipative_lee || norm(motion_.wind()) <= 1) return;
  auto cells = lee_cells(discretization_, comm_);
  const auto owned = cells.begin() + setup_.domain.owned_cells;
  const auto count = comm_.sum(static_cast<GlobalIndex>(std::count(cells.begin(), owned, 1)));
  if (count == 0) return;
  discretization_.set_dissipative(std::move(cells));
  spdlog::info(
      "{} cells behind walls that face aft are of first order, with Van Leer's flux "
      "(space.dissipative_lee)",
      count);
}

std::vector<std::string> turning_patches(const ControlSettings& control, const MeshSettings& mesh) {
  auto out = control.patches;
  for (const auto& patch : control.patches)
    if (std::ranges::find(mesh.aft_jets, patch) != mesh.aft_jets.end()) out.push_back(aft_name(patch));
  return out;
}

PanelFrame frame_of(const ControlSettings& control) {
  const Hinge hinge = hinge_of(control);
  return {hinge.point, hinge.axis};
}

void FlowCase::deflect_controls() {
  control_deflections_ = deflections_of_controls(*this);
  for (std::size_t i = 0; i < settings().controls.size(); ++i)
    check_control(settings().controls[i], control_deflections_[i], *this);
  for (const auto& [name, degrees] : settings().deflections) {
    const auto& control = *std::ranges::find(settings().controls, name, &ControlSettings::name);
    const auto patches = turning_patches(control, settings().mesh);
    const Hinge hinge = hinge_of(control);
    const Real angle = degrees * radians_per_degree;
    if (settings().space.deflection == DeflectionKind::transpiration)
      discretization_.set_turned_walls(turned_further(discretization_, patches, hinge, angle));
    else if (!deflect(setup_.domain, discretization_, patches, hinge, angle, comm_))
      throw InputError(settings().file, 0,
                       fmt::format("the mesh folds while {} is deflected by {:g} degrees", name, degrees),
                       "deflect it less, or mesh it deflected");
  }
  if (!settings().deflections.empty() && settings().space.deflection == DeflectionKind::mesh)
    control_deflections_ = deflections_of_controls(*this);
}

Hinge hinge_of(const ControlSettings& control) {
  return {control.hinge_point, 1 / norm(control.hinge_axis) * control.hinge_axis};
}

Conditions<Real> FlowCase::conditions() const {
  return steady_conditions(motion_.wind(), settings().motion.axis_point, settings().freestream.gamma,
                           motion_.steady_rotation());
}

std::unique_ptr<Treatment> FlowCase::treatment(Real time_step) {
  return make_treatment(settings().motion.treatment, motion_, settings().motion.axis_point, time_step,
                        setup_.domain, discretization_, comm_, gust());
}

std::unique_ptr<GustField> FlowCase::gust() const {
  if (settings().gust.kind == GustKind::none) return nullptr;
  return std::make_unique<GustField>(Gust(settings().gust, settings().freestream.mach, setup_.gust_table),
                                     discretization_);
}

std::unique_ptr<FreeFlight> FlowCase::free_flight(Real time_step) const {
  const auto& reference = settings().reference;
  const RigidBody body(properties_of(settings().body, reference.length, settings().freestream.mach));
  return std::make_unique<FreeFlight>(body, motion_, settings().motion.axis_point, time_step, discretization_,
                                      gust(), reference.moment_center, reference.half_model,
                                      steady_report_.total);
}

RunStatus FlowCase::march(const Observer& observer) {
  const auto now = conditions();
  const Real asked_threshold = settings().space.limiter_threshold;
  const auto limiter_threshold = [&] { return discretization_.space().limiter_threshold; };
  const auto begin = [&] {
    iteration_.set_uniform(now.free_stream);
    iteration_.freeze_limiter(false);
    march_.steady = {};
  };
  const auto observe = [&](const SteadyProgress& p) {
    march_.steady = p.state;
    return !observer || observer(p);
  };
  const auto march_on = [&] {
    return march_to_steady(iteration_, now, gentler(settings().steady, march_.attempt),
                           settings().space.order, observe, march_.steady, early_cfl_max(march_.attempt));
  };
  if (!goes_on_) begin();
  auto result = march_on();
  while (true) {
    if (result.status == RunStatus::diverged && march_.attempt < most_attempts) {
      spdlog::warn("the steady march lost its way in iteration {}: beginning again with gentler steps",
                   result.iterations);
      ++march_.attempt;
    } else if (result.has_stalled && result.orders < well_converged &&
               limiter_threshold() == asked_threshold) {
      discretization_.set_limiter_threshold(damped_share * asked_threshold);
      remark_ = fmt::format(
          "the steady march stalls {:.1f} decades down with space.limiter_threshold = {:g}, "
          "which was lowered to {:g}",
          result.orders, asked_threshold, limiter_threshold());
      spdlog::warn("{}: beginning again", remark_);
    } else {
      break;
    }
    begin();
    result = march_on();
  }
  goes_on_ = false;
  steady_report_ = result.report;
  steady_orders_ = result.free_orders;
  if (const auto& report = result.report; report.positivity_cells + report.positivity_faces > 0)
    spdlog::info(
        "{} cells and {} more faces fall back towards first order to keep density and pressure positive",
        report.positivity_cells, report.positivity_faces);
  if (result.status == RunStatus::diverged)
    throw DivergedError(
        "the steady march found no CFL number that holds (at high incidence "
        "space.flux = \"van_leer\" or \"hllc\" holds where \"roe\" does not)");
  shortfall_ = shortfall_of(result, *this);
  return shortfall_ ? RunStatus::unconverged : result.status;
}

void FlowCase::set_steady_loads(std::vector<Load> loads) {
  steady_report_ = {};
  steady_report_.loads = std::move(loads);
  steady_report_.total = total_of(steady_report_.loads);
}

}  // namespace alphadot
