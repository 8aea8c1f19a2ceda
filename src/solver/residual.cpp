#include "solver/residual.hpp"

#include <algorithm>
#include <type_traits>

#include "core/dual.hpp"
#include "euler/boundary.hpp"

namespace alphadot {

template <class T>
Residual<T>::Residual(const Discretization& discretization, const Communicator& comm)
    : discretization_(discretization),
      reconstruction_(discretization, comm),
      boundary_pressures_(discretization.domain().boundary_faces.size()) {}

template <class T>
void Residual<T>::evaluate(FlowField<T>& flow, const Conditions<T>& conditions, int order,
                           std::span<Conserved<T>> residual) {
  const Subdomain& domain = discretization_.domain();
  const auto cut_end = static_cast<Index>(domain.faces.size());
  fallback_faces_ = 0;
  std::fill(residual.begin(), residual.end(), Conserved<T>{});
  flow.start_exchange();
  if (order > 1) {
    reconstruction_.update(flow);
    reconstruction_.start_exchange();
  }
  interior_faces(flow, conditions, order, 0, domain.cut_face_begin, residual);
  boundary_faces(flow, conditions, order, residual);
  rotating_axes(flow, conditions, residual);
  if (order > 1)
    reconstruction_.finish_exchange();
  else
    flow.finish_exchange();
  interior_faces(flow, conditions, order, domain.cut_face_begin, cut_end, residual);
}

namespace {
/// A reconstructed state is trusted when it keeps this share of the cell's density and pressure.
constexpr Real trusted_share = 0.1;

template <class T>
bool trusted(const Primitive<T>& face, const Primitive<T>& cell) {
  return face[0] > trusted_share * cell[0] && face[4] > trusted_share * cell[4];
}
}  // namespace

template <class T>
Primitive<T> Residual<T>::face_state(const FlowField<T>& flow, Index cell, const Vec3& face_center,
                                     int order) const {
  if (order == 1) return flow[cell];
  const auto state =
      extrapolated(flow[cell], reconstruction_[cell], face_center - discretization_.domain().center[cell]);
  return trusted(state, flow[cell]) ? state : flow[cell];
}

template <class T>
void Residual<T>::interior_faces(const FlowField<T>& flow, const Conditions<T>& conditions, int order,
                                 Index begin, Index end, std::span<Conserved<T>> residual) {
  const Subdomain& domain = discretization_.domain();
  for (Index face = begin; face < end; ++face) {
    const auto [left, right] = domain.faces[face];
    const Real area = norm(domain.face_normal[face]);
    const Vec3 normal = (1 / area) * domain.face_normal[face];
    const Vec3 center = domain.face_center[face];
    Primitive<T> wl = flow[left], wr = flow[right];
    if (order > 1) {
      const auto l = extrapolated(wl, reconstruction_[left], center - domain.center[left]);
      const auto r = extrapolated(wr, reconstruction_[right], center - domain.center[right]);
      if (trusted(l, wl) && trusted(r, wr)) {
        wl = l;
        wr = r;
      } else {
        ++fallback_faces_;
      }
    }
    const T speed = conditions.face_speed(face, center, normal);
    const auto flux = area * numerical_flux(discretization_.flux(), wl, wr, normal, speed);
    residual[left] += flux;
    if (right < domain.owned_cells) residual[right] -= flux;
  }
}

template <class T>
void Residual<T>::boundary_faces(const FlowField<T>& flow, const Conditions<T>& conditions, int order,
                                 std::span<Conserved<T>> residual) {
  const Subdomain& domain = discretization_.domain();
  const Real gamma = discretization_.gamma();
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    const auto& face = domain.boundary_faces[i];
    const Real area = norm(domain.boundary_normal[i]);
    const Vec3 normal = (1 / area) * domain.boundary_normal[i];
    const Vec3 center = domain.boundary_center[i];
    const T speed = conditions.boundary_speed(i, center, normal);
    const auto inside = face_state(flow, face.cell, center, order);
    const BoundaryKind kind = discretization_.kind_of(face);
    boundary_pressures_[i] = boundary_pressure(kind, inside, normal, speed, gamma);
    residual[face.cell] +=
        area * (is_impermeable(kind) ? wall_flux(boundary_pressures_[i], normal, speed)
                                     : far_field_flux(inside, conditions.free_stream, normal, speed, gamma));
  }
}

template <class T>
void Residual<T>::rotating_axes(const FlowField<T>& flow, const Conditions<T>& conditions,
                                std::span<Conserved<T>> residual) {
  const Subdomain& domain = discretization_.domain();
  const auto& rotation = conditions.grid.rotation;
  if (!conditions.turning_source) return;
  if constexpr (std::is_same_v<T, Real>)
    if (dot(rotation, rotation) == 0) return;
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    const T mass = domain.volume[cell] * flow[cell][0];
    const auto turn = mass * cross(rotation, velocity(flow[cell]) - conditions.turning_stream);
    for (int i = 0; i < 3; ++i) residual[cell][i + 1] += turn[i];
    residual[cell][4] += dot(velocity(flow[cell]), turn);  // its work; none while the turning stream is zero
  }
}

template class Residual<Real>;
template class Residual<Dual<1>>;
template class Residual<Dual<2>>;
template class Residual<Dual<3>>;

}  // namespace alphadot
