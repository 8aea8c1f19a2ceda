#include "linear/linearisation.hpp"

#include <algorithm>

#include "euler/independent.hpp"
#include "space/face_geometry.hpp"
#include "space/turned_walls.hpp"

namespace alphadot {

Linearisation::Linearisation(const Discretization& discretization, const Communicator& comm,
                             const FlowField<Real>& flow, const Reconstruction<Real>& reconstruction,
                             const Conditions<Real>& conditions)
    : discretization_(discretization),
      comm_(comm),
      flow_(flow),
      conditions_(conditions),
      faces_(discretization.domain().faces.size()),
      boundary_faces_(discretization.domain().boundary_faces.size()) {
  if (discretization.space().order > 1) slopes_ = reconstruction.limiter_slopes(flow);
  differentiate_faces(reconstruction);
  differentiate_boundary(reconstruction);
  differentiate_turned(reconstruction);
}

void Linearisation::hold_limiter() {
  for (LimiterSlope& slope : slopes_)
    slope.by_delta = slope.by_bound = slope.by_density = slope.by_pressure = {};
}

namespace {

template <int N>
Linearisation::Matrix by_state(const Conserved<Dual<N>>& flux) {
  Linearisation::Matrix out;
  for (int column = 0; column < 5; ++column)
    for (int row = 0; row < 5; ++row) out[static_cast<std::size_t>(5 * column + row)] = flux[row].d[column];
  return out;
}

template <int N>
Five<Real> by_variable(const Conserved<Dual<N>>& flux, int variable) {
  Five<Real> out;
  for (int row = 0; row < 5; ++row) out[row] = flux[row].d[variable];
  return out;
}

}  // namespace

[[gnu::flatten]] void Linearisation::differentiate_faces(const Reconstruction<Real>& reconstruction) {
  constexpr int speed_variable = 5;
  using Number = Dual<6>;
  const Subdomain& domain = discretization_.domain();
  const int order = discretization_.space().order;
  for (std::size_t face = 0; face < faces_.size(); ++face) {
    const auto at = static_cast<Index>(face);
    const auto [area, normal, center] = interior_geometry(domain, face);
    const auto [wl, wr, scaling] = face_states(domain, flow_, reconstruction, at, order);
    Face& out = faces_[face];
    out.scaling = scaling;
    Number speed = conditions_.face_speed(at, center, normal);
    const FluxModel& model = discretization_.flux_of(at);
    out.right = by_state(area * numerical_flux(model, constant<6>(wl), independent<6>(wr), normal, speed));
    speed.d[speed_variable] = 1;
    const auto flux = area * numerical_flux(model, independent<6>(wl), constant<6>(wr), normal, speed);
    out.left = by_state(flux);
    out.speed = by_variable(flux, speed_variable);
  }
}

void Linearisation::differentiate_boundary(const Reconstruction<Real>& reconstruction) {
  constexpr int speed_variable = 5, wind_variable = 6;
  using Number = Dual<9>;
  const Subdomain& domain = discretization_.domain();
  const Real gamma = discretization_.gamma();
  Vec3Of<Number> wind;
  for (int axis = 0; axis < 3; ++axis) {
    wind[axis] = conditions_.free_stream[1 + axis];
    wind[axis].d[wind_variable + axis] = 1;
  }
  const auto outside = free_stream(wind, gamma);
  for (std::size_t i = 0; i < boundary_faces_.size(); ++i) {
    const auto& face = domain.boundary_faces[i];
    const auto [area, normal, center] = boundary_geometry(domain, i);
    const auto [w, scaling] = inner_state(domain, flow_, reconstruction, i, discretization_.space().order);
    BoundaryFace& out = boundary_faces_[i];
    out.scaling = scaling;
    const auto inside = independent<9>(w);
    Number speed = conditions_.boundary_speed(i, center, normal);
    speed.d[speed_variable] = 1;
    const BoundaryKind kind = discretization_.kind_of(face);
    const Number pressure = boundary_pressure(kind, inside, normal, speed, gamma);
    const auto flux = area * boundary_flux(kind, inside, pressure, outside, normal, speed, gamma);
    out.inside = by_state(flux);
    out.speed = by_variable(flux, speed_variable);
    for (int axis = 0; axis < 3; ++axis)
      out.wind[static_cast<std::size_t>(axis)] = by_variable(flux, wind_variable + axis);
    for (int k = 0; k < 5; ++k) out.pressure[k] = pressure.d[k];
    out.pressure_by_speed = pressure.d[speed_variable];
  }
}

void Linearisation::differentiate_turned(const Reconstruction<Real>& reconstruction) {
  constexpr int speed_variable = 5;
  using Number = Dual<6>;
  const Subdomain& domain = discretization_.domain();
  const int order = discretization_.space().order;
  const Real gamma = discretization_.gamma();
  for (const TurnedWall& wall : discretization_.turned_walls()) {
    const auto i = static_cast<std::size_t>(wall.face);
    const auto [area, normal, center] = boundary_geometry(domain, i);
    const auto turned = turned_geometry(domain, wall);
    const auto here = inner_state(domain, flow_, reconstruction, i, order).inside;
    const auto [there, scaling] =
        inner_state(domain, flow_, reconstruction, domain.boundary_faces[i].cell, turned.center, order);
    Number speed_here = conditions_.boundary_speed(i, center, normal);
    Number speed_there = turned_speed(wall, turned, conditions_);
    TurnedFace by_there{};
    {
      Number changing = speed_there;
      changing.d[speed_variable] = 1;
      const auto [pressure, flux] = turned_wall_flux(constant<6>(here), normal, speed_here,
                                                     independent<6>(there), turned.normal, changing, gamma);
      by_there = {by_state(area * flux),
                  by_variable(area * flux, speed_variable),
                  {},
                  pressure.d[speed_variable],
                  scaling};
      for (int k = 0; k < 5; ++k) by_there.pressure[k] = pressure.d[k];
    }
    turned_faces_.push_back(by_there);
    speed_here.d[speed_variable] = 1;
    const auto flux = area * turned_wall_flux(independent<6>(here), normal, speed_here, constant<6>(there),
                                              turned.normal, speed_there, gamma)
                                 .flux;
    BoundaryFace& by_here = boundary_faces_[i];
    by_here = {by_state(flux), by_variable(flux, speed_variable), {}, {}, 0, by_here.scaling};
  }
}

std::size_t Linearisation::bytes() const {
  return slopes_.bytes() + faces_.size() * sizeof(Face) + boundary_faces_.size() * sizeof(BoundaryFace) +
         turned_faces_.size() * sizeof(TurnedFace);
}

}  // namespace alphadot
