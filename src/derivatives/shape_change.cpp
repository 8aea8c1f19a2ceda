#include "derivatives/shape_change.hpp"

#include <algorithm>
#include <array>

#include "space/face_geometry.hpp"

namespace alphadot {

namespace {

/// Times the displacement or the velocity.
constexpr Real step = 1e-5;

/// A copy of a mesh with its discretization and residual.
class DisplacedMesh {
 public:
  DisplacedMesh(ImplicitIteration& iteration, const Conditions<Real>& conditions, bool limiter_held)
      : iteration_(iteration),
        conditions_(conditions),
        about_(iteration.discretization()),
        domain_(about_.domain()),
        discretization_(domain_, about_.patch_kinds(), space_of(about_.space(), limiter_held),
                        about_.gamma()),
        residual_(discretization_, iteration.communicator()) {
    discretization_.set_dissipative(about_.dissipative_cells());
  }

  /// From now on the limiter's factors are those of the latest evaluation.
  void hold_limiter() { residual_.freeze_limiter(true); }
  void displace(std::span<const Vec3> displacement, Real share) {
    for (std::size_t point = 0; point < displacement.size(); ++point)
      domain_.points[point] = about_.domain().points[point] + share * displacement[point];
    domain_.update_metrics();
    discretization_.update_geometry();
  }
  void evaluate(std::vector<Conserved<Real>>& values) {
    residual_.evaluate(iteration_.flow(), conditions_, about_.space().order, values);
  }
  std::vector<Load> of_faces() const {
    return face_loads(discretization_, excess_pressures(discretization_, residual_),
                      iteration_.moment_center());
  }

 private:
  /// Only where a march may freeze them are factors kept.
  static SpaceSettings space_of(SpaceSettings space, bool limiter_held) {
    if (limiter_held) space.freeze_orders = std::max<Real>(space.freeze_orders, 1);
    return space;
  }

  ImplicitIteration& iteration_;
  const Conditions<Real>& conditions_;
  const Discretization& about_;
  Subdomain domain_;
  Discretization discretization_;
  Residual residual_;
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
  DisplacedMesh mesh(iteration, conditions, limiter_held);
  auto out = empty_change(iteration.discretization());
  if (limiter_held) {
    mesh.evaluate(out.residual);
    mesh.hold_limiter();
  }
  auto below = out;
  for (auto* side : {&below, &out}) {
    mesh.displace(displacement, side == &out ? step : -step);
    mesh.evaluate(side->residual);
    side->of_faces = mesh.of_faces();
  }
  difference(out, below);
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
