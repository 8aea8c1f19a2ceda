#include "derivatives/shape_change.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "partition/excerpt.hpp"
#include "space/face_geometry.hpp"

namespace alphadot {

namespace {

/// Times the displacement or the velocity.
constexpr Real step = 1e-5;

/// The neighbours that the residual of a cell looks at, counted in rings of cells around points: its gradient
/// is a fit to the cells around its points, and its fluxes use those of its neighbours.
constexpr int seen_rings = 2;

/// Cells by how far they are from those that are displaced, [total_cells].
std::vector<std::uint8_t> rings_around_displaced(const Subdomain& domain, std::span<const Vec3> displacement,
                                                 const Communicator& comm) {
  std::vector<std::uint8_t> displaced(static_cast<std::size_t>(domain.owned_cells));
  for (std::size_t cell = 0; cell < displaced.size(); ++cell)
    displaced[cell] = std::ranges::any_of(domain.cell_points[cell], [&](Index point) {
      return norm(displacement[static_cast<std::size_t>(point)]) > 0;
    });
  if (std::ranges::count(displaced, 0) == domain.owned_cells) displaced[0] = 1;  // every rank has a cell
  return rings_around(domain, displaced, 2 * seen_rings, comm);
}

/// A copy of what a displacement changes of a mesh, and of what that rests on, with its discretization, flow
/// and residual.
class DisplacedMesh {
 public:
  DisplacedMesh(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                std::span<const Vec3> displacement, bool limiter_held)
      : about_(iteration.discretization()),
        moment_center_(iteration.moment_center()),
        conditions_(conditions),
        rings_(rings_around_displaced(about_.domain(), displacement, iteration.communicator())),
        excerpt_(excerpt_of(about_.domain(), kept())),
        discretization_(excerpt_.domain, about_.patch_kinds(), space_of(about_.space(), limiter_held),
                        about_.gamma()),
        flow_(excerpt_.domain, iteration.communicator()),
        residual_(discretization_, iteration.communicator()),
        values_(static_cast<std::size_t>(excerpt_.domain.owned_cells)) {
    for (const Index point : excerpt_.points)
      displacement_.push_back(displacement[static_cast<std::size_t>(point)]);
    for (std::size_t cell = 0; cell < excerpt_.cells.size(); ++cell)
      flow_[static_cast<Index>(cell)] = iteration.flow()[excerpt_.cells[cell]];
    if (!about_.has_dissipative_cells()) return;
    std::vector<std::uint8_t> dissipative;
    for (const Index cell : excerpt_.cells)
      dissipative.push_back(about_.dissipative_cells()[static_cast<std::size_t>(cell)]);
    discretization_.set_dissipative(std::move(dissipative));
  }

  /// From now on the limiter's factors are those of the mesh as it is.
  void hold_limiter() {
    residual_.evaluate(flow_, conditions_, about_.space().order, values_);
    residual_.freeze_limiter(true);
  }
  /// By so much of the displacement.
  void displace(Real share) {
    for (std::size_t point = 0; point < displacement_.size(); ++point)
      excerpt_.domain.points[point] =
          about_.domain().points[static_cast<std::size_t>(excerpt_.points[point])] +
          share * displacement_[point];
    excerpt_.domain.update_metrics();
    discretization_.update_geometry();
  }
  /// Adds so much of its residual and loads to those of the whole mesh that the displacement changes.
  void add(Real factor, HeldFlowChange& out) {
    residual_.evaluate(flow_, conditions_, about_.space().order, values_);
    const auto loads =
        face_loads(discretization_, excess_pressures(discretization_, residual_), moment_center_);
    const auto is_changed = [&](Index cell) { return rings_[static_cast<std::size_t>(cell)] <= seen_rings; };
    for (std::size_t cell = 0; cell < values_.size(); ++cell)
      if (const Index of_whole = excerpt_.cells[cell]; is_changed(of_whole))
        out.residual[static_cast<std::size_t>(of_whole)] += factor * values_[cell];
    for (std::size_t face = 0; face < loads.size(); ++face) {
      const auto of_whole = static_cast<std::size_t>(excerpt_.boundary_faces[face]);
      if (is_changed(about_.domain().boundary_faces[of_whole].cell))
        out.of_faces[of_whole] += factor * loads[face];
    }
  }

 private:
  /// Only where a march may freeze them are factors kept.
  static SpaceSettings space_of(SpaceSettings space, bool limiter_held) {
    if (limiter_held) space.freeze_orders = std::max<Real>(space.freeze_orders, 1);
    return space;
  }
  std::vector<std::uint8_t> kept() const {
    std::vector<std::uint8_t> out;
    for (const auto ring : rings_) out.push_back(ring <= 2 * seen_rings);
    return out;
  }

  const Discretization& about_;
  Vec3 moment_center_;
  const Conditions<Real>& conditions_;
  std::vector<std::uint8_t> rings_;
  Excerpt excerpt_;
  Discretization discretization_;
  FlowField<Real> flow_;
  Residual residual_;
  std::vector<Vec3> displacement_;       // [points] of the excerpt
  std::vector<Conserved<Real>> values_;  // [owned_cells] of the excerpt
};

/// (above - below) / (2 step), into above.
void difference(HeldFlowChange& above, const HeldFlowChange& below) {
  constexpr Real per = 0.5 / step;
  for (std::size_t cell = 0; cell < above.residual.size(); ++cell)
    above.residual[cell] = per * (above.residual[cell] - below.residual[cell]);
  for (std::size_t face = 0; face < above.of_faces.size(); ++face)
    above.of_faces[face] = per * (above.of_faces[face] - below.of_faces[face]);
}

HeldFlowChange empty_change(const Discretization& discretization) {
  HeldFlowChange out;
  out.residual.resize(static_cast<std::size_t>(discretization.domain().owned_cells));
  out.of_faces.resize(discretization.domain().boundary_faces.size());
  return out;
}

/// Speeds of the faces, along their normals, of points that move.
FaceSpeeds speeds_of(const Subdomain& domain, const GridMotion<Real>& grid, std::span<const Vec3> velocity,
                     Real share) {
  const auto speed = [&](const FaceGeometry& face, const std::array<Index, 3>& corners) {
    Vec3 mean;
    for (const Index point : corners) mean += 1.0 / 3 * velocity[static_cast<std::size_t>(point)];
    return grid.normal_speed(face.center, face.normal) + share * dot(mean, face.normal);
  };
  FaceSpeeds out;
  for (std::size_t face = 0; face < domain.faces.size(); ++face)
    out.interior.push_back(speed(interior_geometry(domain, face), domain.face_points[face]));
  for (std::size_t face = 0; face < domain.boundary_faces.size(); ++face)
    out.boundary.push_back(speed(boundary_geometry(domain, face), domain.boundary_faces[face].points));
  return out;
}

/// [owned_cells] by how much volumes grow in a unit of time.
std::vector<Real> growth(const Subdomain& domain, std::span<const Vec3> velocity) {
  const auto swept = speeds_of(domain, {}, velocity, 1);
  std::vector<Real> out(static_cast<std::size_t>(domain.owned_cells));
  for (std::size_t face = 0; face < domain.faces.size(); ++face) {
    const Real volume = norm(domain.face_normal[face]) * swept.interior[face];
    const auto [left, right] = domain.faces[face];
    out[static_cast<std::size_t>(left)] += volume;
    if (right < domain.owned_cells) out[static_cast<std::size_t>(right)] -= volume;
  }
  for (std::size_t face = 0; face < domain.boundary_faces.size(); ++face)
    out[static_cast<std::size_t>(domain.boundary_faces[face].cell)] +=
        norm(domain.boundary_normal[face]) * swept.boundary[face];
  return out;
}

/// What `side` is with R(W) and the loads of faces as `residual` has them.
void evaluate(HeldFlowChange& side, Residual& residual, const Discretization& discretization,
              ImplicitIteration& iteration, const Conditions<Real>& conditions) {
  residual.evaluate(iteration.flow(), conditions, discretization.space().order, side.residual);
  side.of_faces =
      face_loads(discretization, excess_pressures(discretization, residual), iteration.moment_center());
}

}  // namespace

HeldFlowChange change_by_displacement(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                                      std::span<const Vec3> displacement, bool limiter_held) {
  DisplacedMesh mesh(iteration, conditions, displacement, limiter_held);
  auto out = empty_change(iteration.discretization());
  if (limiter_held) mesh.hold_limiter();
  for (const Real share : {-step, step}) {
    mesh.displace(share);
    mesh.add(0.5 / share, out);
  }
  out.loads = patch_loads(iteration.discretization(), out.of_faces);
  return out;
}

HeldFlowChange change_by_velocity(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                                  std::span<const Vec3> velocity) {
  const Discretization& discretization = iteration.discretization();
  Residual residual(discretization, iteration.communicator());
  auto out = empty_change(discretization), below = out;
  for (auto* side : {&below, &out}) {
    const auto speeds =
        speeds_of(discretization.domain(), conditions.grid, velocity, side == &out ? step : -step);
    auto moving = conditions;
    moving.face_speeds = &speeds;
    evaluate(*side, residual, discretization, iteration, moving);
  }
  difference(out, below);
  const auto grown = growth(discretization.domain(), velocity);
  for (std::size_t cell = 0; cell < grown.size(); ++cell)
    out.residual[cell] +=
        grown[cell] * conserved(iteration.flow()[static_cast<Index>(cell)], discretization.gamma());
  out.loads = patch_loads(discretization, out.of_faces);
  return out;
}

HeldFlowChange change_by_turn(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                              const std::function<std::vector<TurnedWall>(Real)>& walls) {
  Discretization discretization = iteration.discretization();
  Residual residual(discretization, iteration.communicator());
  auto out = empty_change(discretization), below = out;
  for (auto* side : {&below, &out}) {
    discretization.set_turned_walls(walls(side == &out ? step : -step));
    evaluate(*side, residual, discretization, iteration, conditions);
  }
  difference(out, below);
  out.loads = patch_loads(discretization, out.of_faces);
  return out;
}

}  // namespace alphadot
