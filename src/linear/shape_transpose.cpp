#include "linear/shape_transpose.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/symmetric3.hpp"
#include "euler/boundary.hpp"
#include "linear/tangent_transpose.hpp"
#include "linear/transposed_product.hpp"
#include "space/corner_slope.hpp"
#include "space/face_geometry.hpp"
#include "space/forces_transpose.hpp"
#include "space/gradient.hpp"
#include "space/limiter.hpp"

namespace alphadot {

namespace {

/// Sensitivities to the metrics of a mesh, carried on to its points.
class PointSensitivity {
 public:
  explicit PointSensitivity(const Subdomain& domain) : domain_(domain), points_(domain.points.size()) {}

  void add_center(Index cell, const Vec3& by_center) {
    for (const Index point : domain_.cell_points[cell]) points_[point] += 0.25 * by_center;
  }
  /// Volume = (b - a) x (c - a) . (d - a) / 6.
  void add_volume(Index cell, Real by_volume) {
    const auto& corners = domain_.cell_points[cell];
    const Vec3 b = side(corners, 1), c = side(corners, 2), d = side(corners, 3);
    add_sides(corners, by_volume / 6, {cross(c, d), cross(d, b), cross(b, c)});
  }
  /// Area vector = (b - a) x (c - a) / 2.
  void add_triangle(const std::array<Index, 3>& corners, const Vec3& by_area, const Vec3& by_center) {
    const Vec3 b = side(corners, 1), c = side(corners, 2);
    add_sides(corners, 0.5, std::array{cross(c, by_area), cross(by_area, b)});
    for (const Index point : corners) points_[point] += (1.0 / 3) * by_center;
  }
  void add_point(Index point, const Vec3& by_point) { points_[point] += by_point; }
  std::vector<Vec3> take() { return std::move(points_); }

 private:
  template <std::size_t n>
  Vec3 side(const std::array<Index, n>& corners, std::size_t to) const {
    return domain_.points[corners[to]] - domain_.points[corners[0]];
  }
  template <std::size_t n>
  void add_sides(const std::array<Index, n>& corners, Real scale, const std::array<Vec3, n - 1>& by_sides) {
    for (std::size_t to = 1; to < n; ++to) {
      points_[corners[to]] += scale * by_sides[to - 1];
      points_[corners[0]] -= scale * by_sides[to - 1];
    }
  }

  const Subdomain& domain_;
  std::vector<Vec3> points_;
};

/// Gradient of a smooth function of an area vector, by central differences.
template <class Function>
Vec3 by_area(const Vec3& area, Function&& function) {
  constexpr Real relative_step = 1e-5;
  const Real step = relative_step * norm(area);
  Vec3 out;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 above = area, below = area;
    above[axis] += step;
    below[axis] -= step;
    out[axis] = (function(above) - function(below)) / (2 * step);
  }
  return out;
}

Vec3 gradient_of(const Gradient<Real>& gradient, int i) {
  return {gradient.along[0][i], gradient.along[1][i], gradient.along[2][i]};
}

class ShapeTranspose {
 public:
  ShapeTranspose(const Linearisation& linearisation, FlowField<Real>& flow,
                 std::span<const Conserved<Real>> adjoint, std::span<const Load> weights,
                 const Vec3& moment_center)
      : linearisation_(linearisation),
        discretization_(linearisation.discretization()),
        domain_(discretization_.domain()),
        conditions_(linearisation.conditions()),
        flow_(flow),
        adjoint_(adjoint),
        weights_(weights),
        moment_center_(moment_center),
        second_order_(discretization_.space().order > 1),
        reconstruction_(discretization_, linearisation.communicator()),
        points_(domain_) {
    if (second_order_ && discretization_.space().gradient == GradientKind::green_gauss)
      by_values_.resize(static_cast<std::size_t>(domain_.owned_points));
    reconstruction_.update(flow, discretization_.space().order);
  }

  std::vector<Vec3> apply() {
    for (Index face = 0; face < static_cast<Index>(domain_.faces.size()); ++face) interior_face(face);
    for (std::size_t face = 0; face < domain_.boundary_faces.size(); ++face) boundary_face(face);
    if (second_order_) gradients();
    turning_axes();
    return points_.take();
  }

 private:
  Primitive<Real> at_face(Index cell, const Vec3& center, Real scaling) const {
    return extrapolated(flow_[cell], reconstruction_[cell], scaling * (center - domain_.center[cell]));
  }
  /// The way there: state + scaling (face centre - cell centre) . gradient. Returns what is said about the
  /// face's centre.
  Vec3 extrapolation(Index cell, const Primitive<Real>& by_state, Real scaling) {
    Vec3 by_offset;
    for (int i = 0; i < 5; ++i) by_offset += (scaling * by_state[i]) * gradient_of(reconstruction_[cell], i);
    points_.add_center(cell, -by_offset);
    return by_offset;
  }
  /// Of the speed of a face along its unit normal, by its centre.
  Vec3 speed_by_center(const FaceGeometry& face) const {
    return cross(face.normal, conditions_.grid.rotation);
  }

  void interior_face(Index face) {
    const auto [left, right] = domain_.faces[face];
    auto across = adjoint_[static_cast<std::size_t>(left)];
    if (right < domain_.owned_cells) across -= adjoint_[static_cast<std::size_t>(right)];
    const auto& derivatives = linearisation_.faces()[static_cast<std::size_t>(face)];
    const Vec3 center = domain_.face_center[face], area = domain_.face_normal[face];
    const auto l = at_face(left, center, derivatives.scaling),
               r = at_face(right, center, derivatives.scaling);
    const Vec3 flux_by_area = by_area(area, [&](const Vec3& s) {
      const auto [size, normal, at] = face_geometry(s, center);
      return size * product(across, numerical_flux(discretization_.flux_of(face), l, r, normal,
                                                   conditions_.grid.normal_speed(at, normal)));
    });
    Vec3 by_center = product(across, derivatives.speed) *
                     speed_by_center(interior_geometry(domain_, static_cast<std::size_t>(face)));
    if (second_order_) {
      by_center += extrapolation(left, transposed_product(derivatives.left, across), derivatives.scaling);
      by_center += extrapolation(right, transposed_product(derivatives.right, across), derivatives.scaling);
    }
    points_.add_triangle(domain_.face_points[face], flux_by_area, by_center);
  }

  void boundary_face(std::size_t i) {
    const auto& face = domain_.boundary_faces[i];
    const auto& adjoint = adjoint_[static_cast<std::size_t>(face.cell)];
    const auto& derivatives = linearisation_.boundary_faces()[i];
    const Vec3 center = domain_.boundary_center[i], area = domain_.boundary_normal[i];
    const auto inside = at_face(face.cell, center, derivatives.scaling);
    const BoundaryKind kind = discretization_.kind_of(face);
    const Real gamma = discretization_.gamma();
    const bool has_load = kind == BoundaryKind::wall && !weights_.empty();
    const Load weight = has_load ? weights_[static_cast<std::size_t>(face.patch)] : Load{};
    const auto pressure_at = [&](const Vec3& normal) {
      return boundary_pressure(kind, inside, normal, conditions_.grid.normal_speed(center, normal), gamma);
    };
    const Vec3 arm = center - moment_center_;
    const Vec3 all_by_area = by_area(area, [&](const Vec3& s) {
      const auto [size, normal, at] = face_geometry(s, center);
      const Real speed = conditions_.grid.normal_speed(at, normal), pressure = pressure_at(normal);
      const auto flux = boundary_flux(kind, inside, pressure, conditions_.free_stream, normal, speed, gamma);
      return size * product(adjoint, flux) + (pressure - 1 / gamma) * pressure_weight(weight, s, arm);
    });
    const Real excess = pressure_at(boundary_geometry(domain_, i).normal) - 1 / gamma;
    const Real by_pressure = pressure_weight(weight, area, arm);
    Vec3 by_center = excess * cross(area, weight.moment) +
                     (product(adjoint, derivatives.speed) + by_pressure * derivatives.pressure_by_speed) *
                         speed_by_center(boundary_geometry(domain_, i));
    if (second_order_)
      by_center += extrapolation(
          face.cell, transposed_product(derivatives.inside, adjoint) + by_pressure * derivatives.pressure,
          derivatives.scaling);
    points_.add_triangle(face.points, all_by_area, by_center);
  }

  /// What limited gradients say about the centres of their stencils, their corners and their volumes.
  void gradients() {
    TangentTranspose<1> transpose(linearisation_, moment_center_);
    const auto of_limited = transpose.limited_gradients({adjoint_}, {weights_});
    for (Index cell = 0; cell < domain_.owned_cells; ++cell) {
      if (discretization_.is_flat(cell)) continue;
      Gradient<Real> adjoint;
      for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < 5; ++i)
          adjoint.along[axis][i] = of_limited[static_cast<std::size_t>(cell)].along[axis][i].d[0];
      if (linearisation_.limiter_slopes().empty()) {
        unlimited(cell, reconstruction_[cell], adjoint);
      } else {
        const LimiterSlope& slope = linearisation_.limiter_slopes()[cell];
        limiter(cell, slope, adjoint);
        unlimited(cell, slope.gradient, adjoint);
      }
    }
    for (std::size_t point = 0; point < by_values_.size(); ++point)
      point_value(static_cast<Index>(point), by_values_[point]);
  }

  void unlimited(Index cell, const Gradient<Real>& gradients, const Gradient<Real>& adjoint) {
    if (by_values_.empty())
      fit(cell, gradients, adjoint);
    else
      corner_slopes(cell, gradients, adjoint);
  }

  /// Turns the adjoint of the limited gradient into that of the gradient. The way there: phi(delta) g with
  /// delta = g . offset from a corner.
  void limiter(Index cell, const LimiterSlope& slope, Gradient<Real>& adjoint) {
    const LimiterKind kind = discretization_.space().limiter;
    for (int i = 0; i < 5; ++i) {
      const auto entry = static_cast<std::size_t>(i);
      const Vec3 gradient = gradient_of(slope.gradient, i), of_limited = gradient_of(adjoint, i);
      const Real by_factor = dot(gradient, of_limited), by_delta = by_factor * slope.by_delta[i];
      const Index corner = domain_.cell_points[cell][slope.corner[entry]];
      const Vec3 offset = reach(kind) * (domain_.center[cell] - domain_.points[corner]);
      const Vec3 by_gradient = slope.factor[i] * of_limited + by_delta * offset;
      for (int axis = 0; axis < 3; ++axis) adjoint.along[axis][i] = by_gradient[axis];

      const Vec3 by_offset = (reach(kind) * by_delta) * gradient;
      points_.add_center(cell, by_offset);
      points_.add_point(corner, -by_offset);
    }
  }

  /// The way there: with d = c_j - c_i for each cell j around each corner of cell i, (sum d d^T) g = sum d
  /// (q_j - q_i).
  void fit(Index cell, const Gradient<Real>& gradients, const Gradient<Real>& adjoint) {
    const Symmetric3& a = discretization_.inverse_fit(cell);
    std::array<Vec3, 5> gradient, right;
    for (int i = 0; i < 5; ++i) {
      const auto entry = static_cast<std::size_t>(i);
      gradient[entry] = gradient_of(gradients, i);
      right[entry] = a * gradient_of(adjoint, i);
    }
    for (const Index point : domain_.cell_points[cell])
      for (const Index other : domain_.point_cells[point]) {
        if (other == cell) continue;
        const Vec3 d = domain_.center[other] - domain_.center[cell];
        Vec3 by_distance;
        for (int i = 0; i < 5; ++i) {
          const auto& g = gradient[static_cast<std::size_t>(i)];
          const auto& b = right[static_cast<std::size_t>(i)];
          by_distance += (flow_[other][i] - flow_[cell][i] - dot(g, d)) * b - dot(b, d) * g;
        }
        points_.add_center(other, by_distance);
        points_.add_center(cell, -by_distance);
      }
  }

  /// The way there: g = sum over corners of value times slope. As (x_k - x_0) . g = q_k - q_0 is linear in g,
  /// a corner that moves by d changes g by -slope (g . d).
  void corner_slopes(Index cell, const Gradient<Real>& gradients, const Gradient<Real>& adjoint) {
    const auto& corners = domain_.cell_points[cell];
    for (std::size_t corner = 0; corner < corners.size(); ++corner) {
      const Vec3 slope = corner_slope(domain_, cell, corner);
      auto& by_value = by_values_[static_cast<std::size_t>(corners[corner])];
      Vec3 by_corner;
      for (int i = 0; i < 5; ++i) {
        const Real of_slope = dot(gradient_of(adjoint, i), slope);
        by_value[i] += of_slope;
        by_corner -= of_slope * gradient_of(gradients, i);
      }
      points_.add_point(corners[corner], by_corner);
    }
  }

  /// The way there: with d = c_j - x for the cells j around the point, weights w = 1 + lambda . d and the
  /// mean of q_j by them. lambda solves (sum d d^T) lambda = -sum d, then is cut to `kept` of itself by the
  /// cell with the largest |lambda . d|.
  void point_value(Index point, const Primitive<Real>& by_value) {
    const auto cells = domain_.point_cells[point];
    const Vec3 x = domain_.points[point], lambda = discretization_.point_moments(point).lambda;
    Primitive<Real> mean{};
    Real weights = 0, largest = 0;
    Vec3 first;
    Symmetric3 second{};
    for (const Index cell : cells) {
      const Vec3 d = domain_.center[cell] - x;
      const Real correction = dot(lambda, d);
      for (int i = 0; i < 5; ++i) mean[i] += (1 + correction) * flow_[cell][i];
      weights += 1 + correction;
      first += d;
      add_square(second, d);
      largest = std::max(largest, std::abs(correction));
    }
    if (norm(lambda) == 0) return;  // the plain mean
    for (int i = 0; i < 5; ++i) mean[i] /= weights;
    const auto by_weight = [&](Index cell) {
      Real sum = 0;
      for (int i = 0; i < 5; ++i) sum += by_value[i] * (flow_[cell][i] - mean[i]);
      return sum / weights;
    };
    Vec3 by_lambda;
    for (const Index cell : cells) by_lambda += by_weight(cell) * (domain_.center[cell] - x);

    const Symmetric3 inverse_second = inverse(second);
    const Vec3 uncut = -(inverse_second * first);
    const Real kept = norm(lambda) / norm(uncut);
    constexpr Real tie = 1e-9;
    const bool is_cut = kept < 1 - 1e-12;
    const auto cuts = [&](const Vec3& d) { return is_cut && std::abs(dot(lambda, d)) > largest * (1 - tie); };
    Real ties = 0;
    Vec3 by_cut;  // by the larger |lambda . d| of the cells that cut
    for (const Index cell : cells)
      if (const Vec3 d = domain_.center[cell] - x; cuts(d)) {
        ties += 1;
        by_cut += (dot(by_lambda, lambda) / dot(lambda, d)) * d;
      }
    if (ties > 0) by_cut = (1 / ties) * by_cut;
    const Vec3 by_moments = kept * (inverse_second * (by_lambda - by_cut));
    for (const Index cell : cells) {
      const Vec3 d = domain_.center[cell] - x;
      Vec3 by_distance =
          by_weight(cell) * lambda - (1 + dot(uncut, d)) * by_moments - dot(by_moments, d) * uncut;
      if (cuts(d)) by_distance -= (dot(by_lambda, lambda) / (ties * dot(lambda, d))) * lambda;
      points_.add_center(cell, by_distance);
      points_.add_point(point, -by_distance);
    }
  }

  void turning_axes() {
    if (!conditions_.turning_source || dot(conditions_.grid.rotation, conditions_.grid.rotation) == 0) return;
    for (Index cell = 0; cell < domain_.owned_cells; ++cell)
      points_.add_volume(
          cell, product(adjoint_[static_cast<std::size_t>(cell)], turning_source(flow_[cell], conditions_)));
  }

  const Linearisation& linearisation_;
  const Discretization& discretization_;
  const Subdomain& domain_;
  const Conditions<Real>& conditions_;
  const FlowField<Real>& flow_;
  std::span<const Conserved<Real>> adjoint_;
  std::span<const Load> weights_;
  Vec3 moment_center_;
  bool second_order_;
  Reconstruction<Real> reconstruction_;
  std::vector<Primitive<Real>> by_values_;  ///< [points] of Green and Gauss's sums, those of owned cells
  PointSensitivity points_;
};

}  // namespace

std::vector<Vec3> shape_transpose(const Linearisation& linearisation, FlowField<Real>& flow,
                                  std::span<const Conserved<Real>> adjoint, std::span<const Load> weights,
                                  const Vec3& moment_center) {
  return ShapeTranspose(linearisation, flow, adjoint, weights, moment_center).apply();
}

}  // namespace alphadot
