#include "linear/tangent_transpose.hpp"

#include <algorithm>

#include "core/prefetch.hpp"
#include "euler/independent.hpp"
#include "linear/transposed_product.hpp"
#include "space/face_geometry.hpp"
#include "space/forces_transpose.hpp"
#include "space/turned_walls.hpp"

namespace alphadot {

namespace {

/// The way there: state on a face = state + offset . gradient.
template <int N>
void add_extrapolated(const Primitive<Changes<N>>& at_face, const Vec3& offset, Primitive<Changes<N>>& state,
                      Gradient<Changes<N>>& gradient) {
  for (int i = 0; i < 5; ++i) {
    state[i] += at_face[i];
    for (int axis = 0; axis < 3; ++axis) gradient.along[axis][i] += offset[axis] * at_face[i];
  }
}

constexpr Index cells_ahead = 3;  // that the memory is asked for

}  // namespace

template <int N>
TangentTranspose<N>::TangentTranspose(const Linearisation& linearisation, const Vec3& moment_center)
    : linearisation_(linearisation),
      discretization_(linearisation.discretization()),
      moment_center_(moment_center),
      adjoints_(discretization_.domain(), linearisation.communicator(), HaloWidth::faces),
      states_(static_cast<std::size_t>(discretization_.domain().total_cells)),
      states_halo_(discretization_.domain(), linearisation.communicator(), states_),
      reconstruction_(discretization_, linearisation.limiter_slopes()) {}

template <int N>
void TangentTranspose<N>::apply(const Adjoints& adjoints, const Weights& weights, const Images& images) {
  const Subdomain& domain = discretization_.domain();
  const bool second_order = discretization_.space().order > 1;
  faces(adjoints, weights);
  if (second_order) {  // what other ranks wait for first
    reconstruction_.fit_cells(domain.interior_cells, domain.owned_cells, states_);
    reconstruction_.scatter_points(domain.interior_points, domain.owned_points, states_);
    states_halo_.exchange([&] {
      reconstruction_.fit_cells(0, domain.interior_cells, states_);
      reconstruction_.scatter_points(0, domain.interior_points, states_);
      turn_axes();
    });
  } else {
    turn_axes();
  }

  for (Index cell = 0; cell < domain.owned_cells; ++cell)
    for (int i = 0; i < 5; ++i)
      for (int k = 0; k < N; ++k)
        images[static_cast<std::size_t>(k)][static_cast<std::size_t>(cell)][i] =
            states_[static_cast<std::size_t>(cell)][i].d[k];
}

template <int N>
std::span<const Gradient<Changes<N>>> TangentTranspose<N>::limited_gradients(const Adjoints& adjoints,
                                                                             const Weights& weights) {
  faces(adjoints, weights);
  return reconstruction_.gradients();
}

template <int N>
void TangentTranspose<N>::faces(const Adjoints& adjoints, const Weights& weights) {
  const Subdomain& domain = discretization_.domain();
  for (Index cell = 0; cell < domain.owned_cells; ++cell)
    for (int i = 0; i < 5; ++i)
      for (int k = 0; k < N; ++k)
        adjoints_[cell][i].d[k] = adjoints[static_cast<std::size_t>(k)][static_cast<std::size_t>(cell)][i];
  adjoints_.exchange([&] {
    std::ranges::fill(states_, Primitive<Changes<N>>{});
    reconstruction_.clear();
    boundary_faces(weights);
    turned_faces(weights);
    cells(0, domain.interior_cells);
  });
  cells(domain.interior_cells, domain.owned_cells);
}

template <int N>
Changes<N> TangentTranspose<N>::pressure_weights(std::size_t boundary_face, const Vec3& area, const Vec3& at,
                                                 const Weights& weights) const {
  Changes<N> out;
  for (int k = 0; k < N; ++k)
    if (const auto& of_patches = weights[static_cast<std::size_t>(k)]; !of_patches.empty())
      out.d[k] = pressure_weight(discretization_, boundary_face, area, at, of_patches, moment_center_);
  return out;
}

template <int N>
Changes<N> TangentTranspose<N>::pressure_weights(std::size_t boundary_face, const Weights& weights) const {
  const Subdomain& domain = discretization_.domain();
  return pressure_weights(boundary_face, domain.boundary_normal[boundary_face],
                          domain.boundary_center[boundary_face], weights);
}

template <int N>
void TangentTranspose<N>::boundary_faces(const Weights& weights) {
  const Subdomain& domain = discretization_.domain();
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    const Index cell = domain.boundary_faces[i].cell;
    const auto& derivatives = linearisation_.boundary_faces()[i];
    auto inside = transposed_product(derivatives.inside, adjoints_[cell]);
    const Changes<N> pressure = pressure_weights(i, weights);
    for (int k = 0; k < 5; ++k) inside[k] += derivatives.pressure[k] * pressure;
    add_extrapolated(inside, derivatives.scaling * (domain.boundary_center[i] - domain.center[cell]),
                     states_[static_cast<std::size_t>(cell)], reconstruction_[cell]);
  }
}

template <int N>
void TangentTranspose<N>::turned_faces(const Weights& weights) {
  const Subdomain& domain = discretization_.domain();
  auto derivatives = linearisation_.turned_faces().begin();
  for (const TurnedWall& wall : discretization_.turned_walls()) {
    const auto i = static_cast<std::size_t>(wall.face);
    const Index cell = domain.boundary_faces[i].cell;
    const auto [area, normal, at] = turned_geometry(domain, wall);
    auto there = transposed_product(derivatives->there, adjoints_[cell]);
    const Changes<N> pressure = pressure_weights(i, area * normal, at, weights);
    for (int k = 0; k < 5; ++k) there[k] += derivatives->pressure[k] * pressure;
    add_extrapolated(there, derivatives->scaling * (at - domain.center[cell]),
                     states_[static_cast<std::size_t>(cell)], reconstruction_[cell]);
    ++derivatives;
  }
}

/// The way there adds every flux to the left cell and takes it from the right one.
template <int N>
Conserved<Changes<N>> TangentTranspose<N>::across(const FaceCells& cells) const {
  return adjoints_[cells.left] - adjoints_[cells.right];
}

/// Cells collect from their faces, so that they are written once and ghosts not at all.
template <int N>
[[gnu::flatten]] void TangentTranspose<N>::cells(Index begin, Index end) {
  const Subdomain& domain = discretization_.domain();
  for (Index cell = begin; cell < end; ++cell) {
    if (const Index ahead = cell + cells_ahead; ahead < end)
      for (const Index face : domain.cell_faces[ahead]) {
        const auto [left, right] = domain.faces[face];
        const auto& derivatives = linearisation_.faces()[static_cast<std::size_t>(face)];
        prefetch(left == ahead ? derivatives.left : derivatives.right);
        prefetch(adjoints_[left == ahead ? right : left]);
      }
    Primitive<Changes<N>> state = states_[static_cast<std::size_t>(cell)];
    Gradient<Changes<N>> gradient = reconstruction_[cell];
    for (const Index face : domain.cell_faces[cell]) {
      const FaceCells& sides = domain.faces[face];
      const auto& derivatives = linearisation_.faces()[static_cast<std::size_t>(face)];
      const auto at_face =
          transposed_product(sides.left == cell ? derivatives.left : derivatives.right, across(sides));
      add_extrapolated(at_face, derivatives.scaling * (domain.face_center[face] - domain.center[cell]), state,
                       gradient);
    }
    states_[static_cast<std::size_t>(cell)] = state;
    reconstruction_[cell] = gradient;
  }
}

namespace {

/// The source of turning axes by dual numbers in the state, the rotation and the turning stream.
struct TurningSource {
  static constexpr int state = 0, rotation = 5, stream = 8, variables = 11;
  using Number = Dual<variables>;

  explicit TurningSource(const Conditions<Real>& about) {
    for (int i = 0; i < 3; ++i) {
      conditions.grid.rotation[i] = about.grid.rotation[i];
      conditions.grid.rotation[i].d[rotation + i] = 1;
      conditions.turning_stream[i] = about.turning_stream[i];
      conditions.turning_stream[i].d[stream + i] = 1;
    }
  }
  Conserved<Number> at(const Primitive<Real>& w, Real volume) const {
    return Number(volume) * turning_source(independent<variables>(w, state), conditions);
  }
  template <int N>
  static Changes<N> by(int variable, const Conserved<Number>& source, const Conserved<Changes<N>>& adjoint) {
    Changes<N> out;
    for (int row = 0; row < 5; ++row) out += source[row].d[variable] * adjoint[row];
    return out;
  }

  Conditions<Number> conditions;
};

}  // namespace

template <int N>
void TangentTranspose<N>::turn_axes() {
  const Conditions<Real>& about = linearisation_.conditions();
  if (!about.turning_source || dot(about.grid.rotation, about.grid.rotation) == 0) return;
  const Subdomain& domain = discretization_.domain();
  const TurningSource turning(about);
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    const auto source = turning.at(linearisation_.flow()[cell], domain.volume[cell]);
    for (int i = 0; i < 5; ++i)
      states_[static_cast<std::size_t>(cell)][i] +=
          TurningSource::by(TurningSource::state + i, source, adjoints_[cell]);
  }
}

template <int N>
std::array<ConditionsChange, N> TangentTranspose<N>::conditions(const Weights& weights) const {
  const Subdomain& domain = discretization_.domain();
  const Conditions<Real>& about = linearisation_.conditions();
  Vec3Of<Changes<N>> wind, velocity, rotation;
  const auto add_speed = [&](const Changes<N>& speed, const FaceGeometry& face) {
    const Vec3 by_rotation = cross(face.center - about.grid.axis, face.normal);
    for (int axis = 0; axis < 3; ++axis) {
      velocity[axis] += face.normal[axis] * speed;
      rotation[axis] += by_rotation[axis] * speed;
    }
  };
  for (std::size_t face = 0; face < domain.faces.size(); ++face) {
    const auto [left, right] = domain.faces[face];
    auto flux = adjoints_[left];  // of a face between ranks each counts its own cell
    if (right < domain.owned_cells) flux -= adjoints_[right];
    add_speed(product(linearisation_.faces()[face].speed, flux), interior_geometry(domain, face));
  }
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    const auto& derivatives = linearisation_.boundary_faces()[i];
    const auto& adjoint = adjoints_[domain.boundary_faces[i].cell];
    add_speed(
        product(derivatives.speed, adjoint) + derivatives.pressure_by_speed * pressure_weights(i, weights),
        boundary_geometry(domain, i));
    for (int axis = 0; axis < 3; ++axis)
      wind[axis] += product(derivatives.wind[static_cast<std::size_t>(axis)], adjoint);
  }
  auto derivatives = linearisation_.turned_faces().begin();
  for (const TurnedWall& wall : discretization_.turned_walls()) {
    const auto i = static_cast<std::size_t>(wall.face);
    const auto turned = turned_geometry(domain, wall);
    const auto& adjoint = adjoints_[domain.boundary_faces[i].cell];
    const auto pressure = pressure_weights(i, turned.area * turned.normal, turned.center, weights);
    add_speed(product(derivatives->speed, adjoint) + derivatives->pressure_by_speed * pressure, turned);
    ++derivatives;
  }
  if (about.turning_source) {
    const TurningSource turning(about);
    for (Index cell = 0; cell < domain.owned_cells; ++cell) {
      const auto source = turning.at(linearisation_.flow()[cell], domain.volume[cell]);
      for (int axis = 0; axis < 3; ++axis) {
        rotation[axis] += TurningSource::by(TurningSource::rotation + axis, source, adjoints_[cell]);
        wind[axis] += TurningSource::by(TurningSource::stream + axis, source, adjoints_[cell]);
      }
    }
  }
  std::array<ConditionsChange, N> out;
  for (int k = 0; k < N; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      auto& change = out[static_cast<std::size_t>(k)];
      change.wind[axis] = wind[axis].d[k];
      change.grid_velocity[axis] = velocity[axis].d[k];
      change.rotation[axis] = rotation[axis].d[k];
    }
  return out;
}

template <int N>
std::size_t TangentTranspose<N>::bytes() const {
  return adjoints_.bytes() + states_.size() * sizeof(states_[0]) + states_halo_.bytes() +
         reconstruction_.bytes();
}

template class TangentTranspose<1>;
template class TangentTranspose<2>;
template class TangentTranspose<3>;

}  // namespace alphadot
