#include "space/residual.hpp"

#include <algorithm>
#include <array>

#include "core/prefetch.hpp"
#include "euler/boundary.hpp"
#include "space/face_geometry.hpp"
#include "space/turned_walls.hpp"

namespace alphadot {

Residual::Residual(const Discretization& discretization, const Communicator& comm)
    : discretization_(discretization),
      reconstruction_(discretization, comm),
      boundary_pressures_(discretization.domain().boundary_faces.size()) {}

void Residual::evaluate(FlowField<Real>& flow, const Conditions<Real>& conditions, int order,
                        std::span<Conserved<Real>> residual) {
  const Subdomain& domain = discretization_.domain();
  const auto cut_end = static_cast<Index>(domain.faces.size());
  positivity_faces_ = 0;
  std::fill(residual.begin(), residual.end(), Conserved<Real>{});
  reconstruction_.update(flow, order, [&] {
    interior_faces(flow, conditions, order, 0, domain.cut_face_begin, residual);
    boundary_faces(flow, conditions, order, residual);
    turned_walls(flow, conditions, order, residual);
    rotating_axes(flow, conditions, residual);
    gusts(flow, conditions, residual);
  });
  interior_faces(flow, conditions, order, domain.cut_face_begin, cut_end, residual);
}

namespace {

constexpr Index faces_ahead = 24;  // that the memory is asked for

}  // namespace

/// Faces whose fluxes are computed together, one to a lane of the vector registers.
struct Residual::FaceBatch {
  static constexpr int lanes = 8;
  using Lanes = std::array<Real, lanes>;

  std::array<Lanes, 5> left, right, flux;
  std::array<Lanes, 3> area;  // vectors
  Lanes sweep;                // volume that the face sweeps per unit of time

  void set_states(int lane, const Primitive<Real>& l, const Primitive<Real>& r) {
    for (std::size_t i = 0; i < 5; ++i) {
      left[i][static_cast<std::size_t>(lane)] = l[static_cast<int>(i)];
      right[i][static_cast<std::size_t>(lane)] = r[static_cast<int>(i)];
    }
  }
  void set_face(int lane, const Vec3& face_area, Real face_sweep) {
    for (std::size_t i = 0; i < 3; ++i)
      area[i][static_cast<std::size_t>(lane)] = face_area[static_cast<int>(i)];
    sweep[static_cast<std::size_t>(lane)] = face_sweep;
  }
  Conserved<Real> flux_of(int lane) const {
    Conserved<Real> out;
    for (int i = 0; i < 5; ++i) out[i] = flux[static_cast<std::size_t>(i)][static_cast<std::size_t>(lane)];
    return out;
  }

  /// Takes the flux of one lane from another batch.
  void take_flux(int lane, const FaceBatch& from) {
    const auto at = static_cast<std::size_t>(lane);
    for (std::size_t i = 0; i < 5; ++i) flux[i][at] = from.flux[i][at];
  }

  /// flux = |area| flux_function(left, right, normal, speed), for the compiler to vectorise, which it does
  /// only of what it has inlined.
  template <class FluxFunction>
  [[gnu::flatten]] void evaluate(const FluxFunction& flux_function) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const Primitive<Real> l{{left[0][lane], left[1][lane], left[2][lane], left[3][lane], left[4][lane]}};
      const Primitive<Real> r{
          {right[0][lane], right[1][lane], right[2][lane], right[3][lane], right[4][lane]}};
      const Vec3 normal{area[0][lane], area[1][lane], area[2][lane]};
      const Real size = norm(normal), per_area = 1 / size;
      const Conserved<Real> f = flux_function(l, r, per_area * normal, per_area * sweep[lane]);
      for (int i = 0; i < 5; ++i) flux[static_cast<std::size_t>(i)][lane] = size * f[i];
    }
  }

  void evaluate(const FluxModel& model) {
    switch (model.kind) {
      case FluxKind::roe:
        return evaluate([&](const auto& l, const auto& r, const Vec3& n, Real s) {
          return roe_flux(l, r, n, s, model.gamma, model.entropy_fix);
        });
      case FluxKind::van_leer:
        return evaluate([&](const auto& l, const auto& r, const Vec3& n, Real s) {
          return van_leer_flux(l, r, n, s, model.gamma);
        });
      case FluxKind::hllc:
        return evaluate([&](const auto& l, const auto& r, const Vec3& n, Real s) {
          return hllc_flux(l, r, n, s, model.gamma);
        });
    }
  }
};

void Residual::dissipate(Index first, int count, FaceBatch& batch) {
  const auto is_dissipative = [&](int lane) { return discretization_.is_dissipative(first + lane); };
  int lane = 0;
  while (lane < count && !is_dissipative(lane)) ++lane;
  if (lane == count) return;
  FaceBatch other = batch;
  other.evaluate(discretization_.dissipative_flux());
  for (; lane < count; ++lane)
    if (is_dissipative(lane)) batch.take_flux(lane, other);
}

void Residual::interior_faces(const FlowField<Real>& flow, const Conditions<Real>& conditions, int order,
                              Index begin, Index end, std::span<Conserved<Real>> residual) {
  const Subdomain& domain = discretization_.domain();
  FaceBatch batch;
  for (Index first = begin; first < end; first += batch.lanes) {
    const int count = std::min<Index>(batch.lanes, end - first);
    // Left cells come in their order, right ones from anywhere.
    for (Index ahead = first + faces_ahead; ahead < std::min(first + faces_ahead + batch.lanes, end);
         ++ahead) {
      const Index right = domain.faces[ahead].right;
      prefetch(flow[right]);
      prefetch(domain.center[right]);
      if (order > 1) prefetch(reconstruction_[right]);
      if (right < domain.owned_cells) prefetch(residual[right]);
    }
    for (int lane = 0; lane < batch.lanes; ++lane) {
      const Index face = first + std::min(lane, count - 1);  // lanes that are left over repeat the last face
      const Vec3 area = domain.face_normal[face], center = domain.face_center[face];
      const auto [left, right, scaling] = face_states(domain, flow, reconstruction_, face, order);
      if (order > 1 && scaling < 1 && lane < count) ++positivity_faces_;
      batch.set_states(lane, left, right);
      batch.set_face(lane, area, conditions.face_sweep(face, center, area));
    }
    batch.evaluate(discretization_.flux());
    if (discretization_.has_dissipative_cells()) dissipate(first, count, batch);
    for (int lane = 0; lane < count; ++lane) {
      const auto [left, right] = domain.faces[first + lane];
      const auto flux = batch.flux_of(lane);
      residual[left] += flux;
      if (right < domain.owned_cells) residual[right] -= flux;
    }
  }
}

void Residual::boundary_faces(const FlowField<Real>& flow, const Conditions<Real>& conditions, int order,
                              std::span<Conserved<Real>> residual) {
  const Subdomain& domain = discretization_.domain();
  const Real gamma = discretization_.gamma();
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    if (const std::size_t ahead = i + faces_ahead; ahead < domain.boundary_faces.size()) {
      const Index cell = domain.boundary_faces[ahead].cell;
      prefetch(flow[cell]);
      prefetch(domain.center[cell]);
      if (order > 1) prefetch(reconstruction_[cell]);
      prefetch(residual[cell]);
    }
    const auto& face = domain.boundary_faces[i];
    const auto [area, normal, center] = boundary_geometry(domain, i);
    const Real speed = conditions.boundary_speed(i, center, normal);
    const auto inside = inner_state(domain, flow, reconstruction_, i, order).inside;
    const BoundaryKind kind = discretization_.kind_of(face);
    boundary_pressures_[i] = boundary_pressure(kind, inside, normal, speed, gamma);
    residual[face.cell] += area * boundary_flux(kind, inside, boundary_pressures_[i], conditions.free_stream,
                                                normal, speed, gamma);
  }
}

void Residual::turned_walls(const FlowField<Real>& flow, const Conditions<Real>& conditions, int order,
                            std::span<Conserved<Real>> residual) {
  const Subdomain& domain = discretization_.domain();
  for (const TurnedWall& wall : discretization_.turned_walls()) {
    const auto i = static_cast<std::size_t>(wall.face);
    const Index cell = domain.boundary_faces[i].cell;
    const auto [area, normal, center] = boundary_geometry(domain, i);
    const auto turned = turned_geometry(domain, wall);
    const Real speed = conditions.boundary_speed(i, center, normal);
    const auto [pressure, flux] =
        turned_wall_flux(inner_state(domain, flow, reconstruction_, i, order).inside, normal, speed,
                         inner_state(domain, flow, reconstruction_, cell, turned.center, order).inside,
                         turned.normal, turned_speed(wall, turned, conditions), discretization_.gamma());
    residual[cell] += area * (flux - wall_flux(boundary_pressures_[i], normal, speed));
    boundary_pressures_[i] = pressure;
  }
}

void Residual::rotating_axes(const FlowField<Real>& flow, const Conditions<Real>& conditions,
                             std::span<Conserved<Real>> residual) {
  const Subdomain& domain = discretization_.domain();
  const auto& rotation = conditions.grid.rotation;
  if (!conditions.turning_source || !(dot(rotation, rotation) > 0)) return;
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    residual[cell] += domain.volume[cell] * turning_source(flow[cell], conditions);
  }
}

void Residual::gusts(const FlowField<Real>& flow, const Conditions<Real>& conditions,
                     std::span<Conserved<Real>> residual) {
  if (!conditions.gust) return;
  for (std::size_t cell = 0; cell < residual.size(); ++cell)
    residual[cell] += gust_source(flow[static_cast<Index>(cell)], conditions, cell, discretization_.gamma());
}

}  // namespace alphadot
