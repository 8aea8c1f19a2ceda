#include "solver/reconstruction.hpp"

#include <array>
#include <cmath>

#include "core/dual.hpp"
#include "solver/limiter.hpp"

namespace alphadot {

template <class T>
Reconstruction<T>::Reconstruction(const Discretization& discretization, const Communicator& comm)
    : discretization_(discretization),
      gradients_(discretization.domain(), comm, HaloWidth::faces),
      points_(static_cast<std::size_t>(discretization.domain().owned_points)) {}

template <class T>
void Reconstruction<T>::update(const FlowField<T>& flow) {
  gather_points(flow);
  fit_cells(flow);
}

template <class T>
void Reconstruction<T>::gather_points(const FlowField<T>& flow) {
  const Subdomain& domain = discretization_.domain();
  for (Index point = 0; point < domain.owned_points; ++point) {
    const auto cells = domain.point_cells[point];
    const Vec3 x = domain.points[point];
    PointSums sums{};
    sums.minimum = sums.maximum = flow[cells[0]];
    for (const Index cell : cells) {
      const Primitive<T>& w = flow[cell];
      const Vec3 d = domain.center[cell] - x;
      for (int i = 0; i < 5; ++i) {
        sums.value[i] += w[i];
        sums.moment.along[0][i] += d.x * w[i];
        sums.moment.along[1][i] += d.y * w[i];
        sums.moment.along[2][i] += d.z * w[i];
        sums.minimum[i] = w[i] < sums.minimum[i] ? w[i] : sums.minimum[i];
        sums.maximum[i] = w[i] > sums.maximum[i] ? w[i] : sums.maximum[i];
      }
    }
    points_[point] = sums;
  }
}

template <class T>
void Reconstruction<T>::fit_cells(const FlowField<T>& flow) {
  const Subdomain& domain = discretization_.domain();
  const LimiterKind limiter = discretization_.space().limiter;
  const Real k3 = std::pow(discretization_.space().limiter_k, 3);
  const Real gamma = discretization_.gamma();
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    const auto& corners = domain.cell_points[cell];
    const Primitive<T>& w = flow[cell];
    std::array<Vec3, 4> arm;  // from each corner to the centroid
    Gradient<T> right{};
    Vec3 offset{};
    Primitive<T> minimum = points_[corners[0]].minimum, maximum = points_[corners[0]].maximum;
    for (int corner = 0; corner < 4; ++corner) {
      const Index point = corners[corner];
      const PointSums& sums = points_[point];
      const PointMoments& moments = discretization_.point_moments(point);
      const Vec3 e = domain.center[cell] - domain.points[point];
      arm[corner] = e;
      offset += moments.first - moments.count * e;
      for (int i = 0; i < 5; ++i) {
        for (int axis = 0; axis < 3; ++axis)
          right.along[axis][i] += sums.moment.along[axis][i] - e[axis] * sums.value[i];
        minimum[i] = sums.minimum[i] < minimum[i] ? sums.minimum[i] : minimum[i];
        maximum[i] = sums.maximum[i] > maximum[i] ? sums.maximum[i] : maximum[i];
      }
    }
    const Symmetric3& a = discretization_.inverse_fit(cell);
    // (K h)^3 with h^3 = 6 V (a cube's corner); scales of density, speed and pressure: 1, 1 and 1/gamma.
    const Real epsilon2 = k3 * 6 * domain.volume[cell];
    Gradient<T>& gradient = gradients_[cell];
    for (int i = 0; i < 5; ++i) {
      const T bx = right.along[0][i] - offset.x * w[i], by = right.along[1][i] - offset.y * w[i],
              bz = right.along[2][i] - offset.z * w[i];
      const Vec3Of<T> g{a.xx * bx + a.xy * by + a.xz * bz, a.xy * bx + a.yy * by + a.yz * bz,
                        a.xz * bx + a.yz * by + a.zz * bz};
      T factor = T(1);
      if (limiter != LimiterKind::none) {
        const T up = maximum[i] - w[i], down = minimum[i] - w[i];
        const Real scaled_epsilon2 = i == 4 ? epsilon2 / (gamma * gamma) : epsilon2;
        for (int corner = 0; corner < 4; ++corner) {
          // The face opposite a corner lies a third of the arm beyond the centroid.
          const T delta = (1.0 / 3) * dot(arm[corner], g);
          const T& room = delta > T(0) ? up : down;
          const T phi = limiter == LimiterKind::venkatakrishnan
                            ? venkatakrishnan(delta, room, scaled_epsilon2)
                            : barth_jespersen(delta, room);
          factor = phi < factor ? phi : factor;
        }
      }
      for (int axis = 0; axis < 3; ++axis) gradient.along[axis][i] = factor * g[axis];
    }
  }
}

template class Reconstruction<Real>;
template class Reconstruction<Dual<1>>;
template class Reconstruction<Dual<2>>;
template class Reconstruction<Dual<3>>;

}  // namespace alphadot
