#include "solver/tangent.hpp"

namespace alphadot {

template <int N>
Tangent<N>::Tangent(const Discretization& discretization, const Communicator& comm,
                    const FlowField<Real>& flow, const Conditions<Real>& conditions,
                    const Vec3& moment_center)
    : discretization_(discretization),
      conditions_(conditions),
      moment_center_(moment_center),
      flow_(discretization.domain(), comm),
      residual_(discretization, comm),
      values_(static_cast<std::size_t>(discretization.domain().owned_cells)) {
  for (Index cell = 0; cell < discretization.domain().owned_cells; ++cell)
    for (int i = 0; i < 5; ++i) flow_[cell][i].v = flow[cell][i];
}

namespace {

template <int N>
Dual<N> with_derivatives(Real value, const std::array<Real, N>& derivatives) {
  Dual<N> out = value;
  for (int k = 0; k < N; ++k) out.d[k] = derivatives[static_cast<std::size_t>(k)];
  return out;
}

/// A vector whose derivatives are the given member of every change.
template <int N>
Vec3Of<Dual<N>> with_changes(const Vec3& value, const std::array<ConditionsChange, N>& changes,
                             Vec3 ConditionsChange::*member) {
  Vec3Of<Dual<N>> out;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<Real, N> derivatives;
    for (std::size_t k = 0; k < N; ++k) derivatives[k] = (changes[k].*member)[axis];
    out[axis] = with_derivatives<N>(value[axis], derivatives);
  }
  return out;
}

}  // namespace

template <int N>
void Tangent<N>::apply(const Fields& fields, const std::array<ConditionsChange, N>& changes,
                       const Images& images) {
  const Index cells = discretization_.domain().owned_cells;
  for (Index cell = 0; cell < cells; ++cell)
    for (int i = 0; i < 5; ++i)
      for (int k = 0; k < N; ++k)
        flow_[cell][i].d[k] = fields[static_cast<std::size_t>(k)][static_cast<std::size_t>(cell)][i];

  Conditions<Dual<N>> conditions;
  const auto wind = with_changes<N>(velocity(conditions_.free_stream), changes, &ConditionsChange::wind);
  conditions.free_stream = free_stream(wind, discretization_.gamma());
  conditions.grid.velocity =
      with_changes<N>(conditions_.grid.velocity, changes, &ConditionsChange::grid_velocity);
  conditions.grid.rotation = with_changes<N>(conditions_.grid.rotation, changes, &ConditionsChange::rotation);
  conditions.grid.axis = conditions_.grid.axis;
  conditions.turning_stream = wind;

  residual_.evaluate(flow_, conditions, discretization_.space().order, values_);
  for (Index cell = 0; cell < cells; ++cell)
    for (int i = 0; i < 5; ++i)
      for (std::size_t k = 0; k < N; ++k)
        images[k][static_cast<std::size_t>(cell)][i] = values_[static_cast<std::size_t>(cell)][i].d[k];
}

template <int N>
std::array<std::vector<Load>, N> Tangent<N>::loads() const {
  const auto duals = wall_loads(discretization_, residual_, moment_center_);
  std::array<std::vector<Load>, N> out;
  for (std::size_t k = 0; k < N; ++k)
    for (const auto& load : duals) {
      Load& change = out[k].emplace_back();
      for (int i = 0; i < 3; ++i) {
        change.force[i] = load.force[i].d[k];
        change.moment[i] = load.moment[i].d[k];
      }
    }
  return out;
}

template class Tangent<1>;
template class Tangent<2>;
template class Tangent<3>;

}  // namespace alphadot
