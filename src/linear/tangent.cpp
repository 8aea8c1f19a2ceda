#include "linear/tangent.hpp"

#include <algorithm>

#include "core/dual.hpp"
#include "core/prefetch.hpp"
#include "space/face_geometry.hpp"
#include "space/turned_walls.hpp"

namespace alphadot {

template <int N>
Tangent<N>::Tangent(const Linearisation& linearisation, const Vec3& moment_center)
    : linearisation_(linearisation),
      discretization_(linearisation.discretization()),
      moment_center_(moment_center),
      flow_(discretization_.domain(), linearisation.communicator()),
      reconstruction_(discretization_, linearisation.communicator()),
      values_(static_cast<std::size_t>(discretization_.domain().owned_cells)),
      pressures_(discretization_.domain().boundary_faces.size()) {
  reconstruction_.follow(linearisation.limiter_slopes());
}

template <int N>
void Tangent<N>::apply(const Fields& fields, const std::array<ConditionsChange, N>& changes,
                       const Images& images) {
  const Subdomain& domain = discretization_.domain();
  for (Index cell = 0; cell < domain.owned_cells; ++cell)
    for (int i = 0; i < 5; ++i)
      for (int k = 0; k < N; ++k)
        flow_[cell][i].d[k] = fields[static_cast<std::size_t>(k)][static_cast<std::size_t>(cell)][i];
  std::ranges::fill(values_, Conserved<Changes<N>>{});

  reconstruction_.update(flow_, discretization_.space().order, [&] {
    interior_faces(0, domain.cut_face_begin);
    boundary_faces();
    turned_faces();
    turn_axes(changes);
  });
  interior_faces(domain.cut_face_begin, static_cast<Index>(domain.faces.size()));
  const auto is_zero = [](const ConditionsChange& c) {
    return dot(c.wind, c.wind) + dot(c.grid_velocity, c.grid_velocity) + dot(c.rotation, c.rotation) == 0;
  };
  if (!std::ranges::all_of(changes, is_zero))
    force_faces(forcing_of(changes, linearisation_.conditions().grid.axis));

  for (Index cell = 0; cell < domain.owned_cells; ++cell)
    for (int i = 0; i < 5; ++i)
      for (int k = 0; k < N; ++k)
        images[static_cast<std::size_t>(k)][static_cast<std::size_t>(cell)][i] =
            values_[static_cast<std::size_t>(cell)][i].d[k];
}

namespace {

/// out += A x, column by column.
template <int N>
void add_product(Five<Changes<N>>& out, const Linearisation::Matrix& a, const Five<Changes<N>>& x) {
  for (int column = 0; column < 5; ++column)
    for (int row = 0; row < 5; ++row) out[row] += a[static_cast<std::size_t>(5 * column + row)] * x[column];
}

template <int N>
void add_product(Five<Changes<N>>& out, const Five<Real>& a, const Changes<N>& x) {
  for (int row = 0; row < 5; ++row) out[row] += a[row] * x;
}

constexpr Index faces_ahead = 16;  // that the memory is asked for

}  // namespace

template <int N>
Primitive<Changes<N>> Tangent<N>::at_face(Index cell, const Vec3& face_center, Real scaling) const {
  return extrapolated(flow_[cell], reconstruction_[cell],
                      scaling * (face_center - discretization_.domain().center[cell]));
}

template <int N>
[[gnu::flatten]] void Tangent<N>::interior_faces(Index begin, Index end) {
  const Subdomain& domain = discretization_.domain();
  for (Index face = begin; face < end; ++face) {
    if (const Index ahead = face + faces_ahead; ahead < end) {
      const Index right = domain.faces[ahead].right;
      prefetch(flow_[right]);
      prefetch(domain.center[right]);
      prefetch(reconstruction_[right]);
      if (right < domain.owned_cells) prefetch(values_[static_cast<std::size_t>(right)]);
    }
    const auto [left, right] = domain.faces[face];
    const Vec3& center = domain.face_center[face];
    const auto& derivatives = linearisation_.faces()[static_cast<std::size_t>(face)];
    Conserved<Changes<N>> flux{};
    add_product(flux, derivatives.left, at_face(left, center, derivatives.scaling));
    add_product(flux, derivatives.right, at_face(right, center, derivatives.scaling));
    values_[static_cast<std::size_t>(left)] += flux;
    if (right < domain.owned_cells) values_[static_cast<std::size_t>(right)] -= flux;
  }
}

template <int N>
void Tangent<N>::boundary_faces() {
  const Subdomain& domain = discretization_.domain();
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    const Index cell = domain.boundary_faces[i].cell;
    const auto& derivatives = linearisation_.boundary_faces()[i];
    const auto inside = at_face(cell, domain.boundary_center[i], derivatives.scaling);
    add_product(values_[static_cast<std::size_t>(cell)], derivatives.inside, inside);
    pressures_[i] = {};
    for (int k = 0; k < 5; ++k) pressures_[i] += derivatives.pressure[k] * inside[k];
  }
}

template <int N>
void Tangent<N>::turned_faces() {
  const Subdomain& domain = discretization_.domain();
  auto derivatives = linearisation_.turned_faces().begin();
  for (const TurnedWall& wall : discretization_.turned_walls()) {
    const auto i = static_cast<std::size_t>(wall.face);
    const Index cell = domain.boundary_faces[i].cell;
    const auto there = at_face(cell, turned_geometry(domain, wall).center, derivatives->scaling);
    add_product(values_[static_cast<std::size_t>(cell)], derivatives->there, there);
    for (int k = 0; k < 5; ++k) pressures_[i] += derivatives->pressure[k] * there[k];
    ++derivatives;
  }
}

template <int N>
typename Tangent<N>::Forcing Tangent<N>::forcing_of(const std::array<ConditionsChange, N>& changes,
                                                    const Vec3& axis) {
  Forcing out;
  out.grid.axis = axis;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < N; ++k) {
      const ConditionsChange& change = changes[static_cast<std::size_t>(k)];
      out.wind[i].d[k] = change.wind[i];
      out.grid.velocity[i].d[k] = change.grid_velocity[i];
      out.grid.rotation[i].d[k] = change.rotation[i];
    }
  return out;
}

template <int N>
void Tangent<N>::force_faces(const Forcing& forcing) {
  const Subdomain& domain = discretization_.domain();
  const auto speed_of = [&](const FaceGeometry& face) {
    return dot(face.normal, forcing.grid.at(face.center));
  };
  for (std::size_t face = 0; face < domain.faces.size(); ++face) {
    const auto [left, right] = domain.faces[face];
    Conserved<Changes<N>> flux{};
    add_product(flux, linearisation_.faces()[face].speed, speed_of(interior_geometry(domain, face)));
    values_[static_cast<std::size_t>(left)] += flux;
    if (right < domain.owned_cells) values_[static_cast<std::size_t>(right)] -= flux;
  }
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    const auto& derivatives = linearisation_.boundary_faces()[i];
    const auto speed = speed_of(boundary_geometry(domain, i));
    auto& value = values_[static_cast<std::size_t>(domain.boundary_faces[i].cell)];
    add_product(value, derivatives.speed, speed);
    for (int axis = 0; axis < 3; ++axis)
      add_product(value, derivatives.wind[static_cast<std::size_t>(axis)], forcing.wind[axis]);
    pressures_[i] += derivatives.pressure_by_speed * speed;
  }
  auto derivatives = linearisation_.turned_faces().begin();
  for (const TurnedWall& wall : discretization_.turned_walls()) {
    const auto i = static_cast<std::size_t>(wall.face);
    const auto speed = speed_of(turned_geometry(domain, wall));
    add_product(values_[static_cast<std::size_t>(domain.boundary_faces[i].cell)], derivatives->speed, speed);
    pressures_[i] += derivatives->pressure_by_speed * speed;
    ++derivatives;
  }
}

/// The source of turning axes, which few flows have, by dual numbers on the spot.
template <int N>
void Tangent<N>::turn_axes(const std::array<ConditionsChange, N>& changes) {
  const Conditions<Real>& about = linearisation_.conditions();
  const auto turns = [](const Vec3& rotation) { return dot(rotation, rotation) > 0; };
  if (!about.turning_source ||
      !(turns(about.grid.rotation) || std::ranges::any_of(changes, turns, &ConditionsChange::rotation)))
    return;
  Conditions<Dual<N>> conditions;
  for (int i = 0; i < 3; ++i) {
    conditions.grid.rotation[i] = about.grid.rotation[i];
    conditions.turning_stream[i] = about.turning_stream[i];
    for (int k = 0; k < N; ++k) {
      conditions.grid.rotation[i].d[k] = changes[static_cast<std::size_t>(k)].rotation[i];
      conditions.turning_stream[i].d[k] = changes[static_cast<std::size_t>(k)].wind[i];
    }
  }
  const Subdomain& domain = discretization_.domain();
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    Primitive<Dual<N>> w;
    for (int i = 0; i < 5; ++i) {
      w[i] = linearisation_.flow()[cell][i];
      for (int k = 0; k < N; ++k) w[i].d[k] = flow_[cell][i].d[k];
    }
    const auto source = domain.volume[cell] * turning_source(w, conditions);
    for (int i = 0; i < 5; ++i) {
      Changes<N> change;
      for (int k = 0; k < N; ++k) change.d[k] = source[i].d[k];
      values_[static_cast<std::size_t>(cell)][i] += change;
    }
  }
}

template <int N>
std::array<std::vector<Real>, N> Tangent<N>::pressures() const {
  std::array<std::vector<Real>, N> out;
  for (int k = 0; k < N; ++k)
    for (const auto& changes : pressures_) out[static_cast<std::size_t>(k)].push_back(changes.d[k]);
  return out;
}

template <int N>
std::array<std::vector<Load>, N> Tangent<N>::loads() const {
  std::array<std::vector<Load>, N> out;
  const auto of_faces = pressures();
  for (std::size_t k = 0; k < N; ++k) out[k] = wall_loads(discretization_, of_faces[k], moment_center_);
  return out;
}

template class Tangent<1>;
template class Tangent<2>;
template class Tangent<3>;
template class Tangent<4>;

}  // namespace alphadot
