#include "space/residual.hpp"

#include <algorithm>
#include <array>
#include <type_traits>

#include "core/prefetch.hpp"
#include "euler/boundary.hpp"
#include "space/face_geometry.hpp"

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
  positivity_faces_ = 0;
  std::fill(residual.begin(), residual.end(), Conserved<T>{});
  reconstruction_.update(flow, order, [&] {
    interior_faces(flow, conditions, order, 0, domain.cut_face_begin, residual);
    boundary_faces(flow, conditions, order, residual);
    rotating_axes(flow, conditions, residual);
  });
  interior_faces(flow, conditions, order, domain.cut_face_begin, cut_end, residual);
}

template <class T>
Primitive<T> Residual<T>::face_state(const FlowField<T>& flow, Index cell, const Vec3& face_center,
                                     int order) const {
  if (order == 1) return flow[cell];
  const auto state =
      extrapolated(flow[cell], reconstruction_[cell], face_center - discretization_.domain().center[cell]);
  const T scaling = positivity_scaling(state, flow[cell]);
  return flow[cell] + scaling * (state - flow[cell]);
}

namespace {

constexpr Index faces_ahead = 24;  // that the memory is asked for

/// Faces whose fluxes are computed together, one to a lane of the vector registers. Other numbers come alone.
template <class T>
struct FaceBatch {
  static constexpr int lanes = std::is_same_v<T, Real> ? 8 : 1;
  using Lanes = std::array<T, lanes>;

  std::array<Lanes, 5> left, right, flux;
  std::array<std::array<Real, lanes>, 3> area;  // vectors
  Lanes sweep;                                  // volume that the face sweeps per unit of time

  void set_states(int lane, const Primitive<T>& l, const Primitive<T>& r) {
    for (std::size_t i = 0; i < 5; ++i) {
      left[i][static_cast<std::size_t>(lane)] = l[static_cast<int>(i)];
      right[i][static_cast<std::size_t>(lane)] = r[static_cast<int>(i)];
    }
  }
  void set_face(int lane, const Vec3& face_area, const T& face_sweep) {
    for (std::size_t i = 0; i < 3; ++i)
      area[i][static_cast<std::size_t>(lane)] = face_area[static_cast<int>(i)];
    sweep[static_cast<std::size_t>(lane)] = face_sweep;
  }
  Conserved<T> flux_of(int lane) const {
    Conserved<T> out;
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
      const Primitive<T> l{{left[0][lane], left[1][lane], left[2][lane], left[3][lane], left[4][lane]}};
      const Primitive<T> r{{right[0][lane], right[1][lane], right[2][lane], right[3][lane], right[4][lane]}};
      const Vec3 normal{area[0][lane], area[1][lane], area[2][lane]};
      const Real size = norm(normal), per_area = 1 / size;
      const Conserved<T> f = flux_function(l, r, per_area * normal, T(per_area * sweep[lane]));
      for (int i = 0; i < 5; ++i) flux[static_cast<std::size_t>(i)][lane] = size * f[i];
    }
  }

  void evaluate(const FluxModel& model) {
    switch (model.kind) {
      case FluxKind::roe:
        return evaluate([&](const auto& l, const auto& r, const Vec3& n, const T& s) {
          return roe_flux(l, r, n, s, model.gamma, model.entropy_fix);
        });
      case FluxKind::van_leer:
        return evaluate([&](const auto& l, const auto& r, const Vec3& n, const T& s) {
          return van_leer_flux(l, r, n, s, model.gamma);
        });
      case FluxKind::hllc:
        return evaluate([&](const auto& l, const auto& r, const Vec3& n, const T& s) {
          return hllc_flux(l, r, n, s, model.gamma);
        });
    }
  }
};

}  // namespace

template <class T>
template <class Batch>
void Residual<T>::dissipate(Index first, int count, Batch& batch) {
  const auto is_dissipative = [&](int lane) { return discretization_.is_dissipative(first + lane); };
  int lane = 0;
  while (lane < count && !is_dissipative(lane)) ++lane;
  if (lane == count) return;
  Batch other = batch;
  other.evaluate(discretization_.dissipative_flux());
  for (; lane < count; ++lane)
    if (is_dissipative(lane)) batch.take_flux(lane, other);
}

template <class T>
void Residual<T>::interior_faces(const FlowField<T>& flow, const Conditions<T>& conditions, int order,
                                 Index begin, Index end, std::span<Conserved<T>> residual) {
  const Subdomain& domain = discretization_.domain();
  FaceBatch<T> batch;
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
      const auto [left, right] = domain.faces[face];
      const Vec3 area = domain.face_normal[face], center = domain.face_center[face];
      Primitive<T> wl = flow[left], wr = flow[right];
      if (order > 1) {
        const auto l = extrapolated(wl, reconstruction_[left], center - domain.center[left]);
        const auto r = extrapolated(wr, reconstruction_[right], center - domain.center[right]);
        const T of_left = positivity_scaling(l, wl), of_right = positivity_scaling(r, wr);
        const T scaling = of_left < of_right ? of_left : of_right;
        if (scaling < T(1)) {
          wl += scaling * (l - wl);
          wr += scaling * (r - wr);
          if (lane < count) ++positivity_faces_;
        } else {
          wl = l;
          wr = r;
        }
      }
      batch.set_states(lane, wl, wr);
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

template <class T>
void Residual<T>::boundary_faces(const FlowField<T>& flow, const Conditions<T>& conditions, int order,
                                 std::span<Conserved<T>> residual) {
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
    const T speed = conditions.boundary_speed(i, center, normal);
    const auto inside = face_state(flow, face.cell, center, order);
    const BoundaryKind kind = discretization_.kind_of(face);
    boundary_pressures_[i] = boundary_pressure(kind, inside, normal, speed, gamma);
    residual[face.cell] += area * boundary_flux(kind, inside, boundary_pressures_[i], conditions.free_stream,
                                                normal, speed, gamma);
  }
}

template <class T>
void Residual<T>::rotating_axes(const FlowField<T>& flow, const Conditions<T>& conditions,
                                std::span<Conserved<T>> residual) {
  const Subdomain& domain = discretization_.domain();
  const auto& rotation = conditions.grid.rotation;
  if (!conditions.turning_source || !(dot(rotation, rotation) > T(0))) return;
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    residual[cell] += domain.volume[cell] * turning_source(flow[cell], conditions);
  }
}

template class Residual<Real>;

}  // namespace alphadot
