#include "march/deflection.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/symmetric3.hpp"
#include "march/blend.hpp"
#include "partition/point_sums.hpp"
#include "space/flow_field.hpp"

namespace alphadot {

namespace {

constexpr Real infinity = std::numeric_limits<Real>::infinity();

/// The box around walls that turn: along the hinge, along their mean normal across it, and across both.
class HingedBox {
 public:
  HingedBox(const Subdomain& domain, std::span<const std::uint8_t> turns, const Hinge& hinge,
            const Communicator& comm)
      : origin_(hinge.point) {
    const Vec3 aside = std::abs(hinge.axis.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 f = unit(cross(hinge.axis, aside)), g = cross(hinge.axis, f);
    std::vector<Real> sums(3);  // of area times squares of the normal's parts along f and g
    for_faces(domain, turns, [&](std::size_t face) {
      const Vec3 area = domain.boundary_normal[face];
      const Real along_f = dot(area, f), along_g = dot(area, g), size = norm(area);
      sums[0] += along_f * along_f / size;
      sums[1] += along_f * along_g / size;
      sums[2] += along_g * along_g / size;
    });
    comm.sum(sums);
    const Real angle = 0.5 * std::atan2(2 * sums[1], sums[0] - sums[2]);
    const Vec3 flat = std::cos(angle) * f + std::sin(angle) * g;
    axes_ = {hinge.axis, flat, cross(hinge.axis, flat)};
    lower_.fill(infinity);
    upper_.fill(-infinity);
    for_faces(domain, turns, [&](std::size_t face) {
      for (const Index point : domain.boundary_faces[face].points)
        for (std::size_t i = 0; i < 3; ++i) {
          const Real at = dot(axes_[i], domain.points[static_cast<std::size_t>(point)] - origin_);
          lower_[i] = std::min(lower_[i], at);
          upper_[i] = std::max(upper_[i], at);
        }
    });
    comm.min(std::span<Real>(lower_));
    comm.max(std::span<Real>(upper_));
  }

  Real diagonal() const {
    return std::hypot(upper_[0] - lower_[0], upper_[1] - lower_[1], upper_[2] - lower_[2]);
  }
  /// Of the hinge line; 0 where it meets the box.
  Real hinge_distance() const {
    const auto from = [&](std::size_t i) { return std::max({lower_[i], -upper_[i], Real{0}}); };
    return std::hypot(from(1), from(2));
  }
  /// 0 inside.
  Real distance(const Vec3& x) const {
    std::array<Real, 3> d;
    for (std::size_t i = 0; i < 3; ++i) {
      const Real at = dot(axes_[i], x - origin_);
      d[i] = std::max({lower_[i] - at, at - upper_[i], Real{0}});
    }
    return std::hypot(d[0], d[1], d[2]);
  }

 private:
  static Vec3 unit(const Vec3& v) { return 1 / norm(v) * v; }
  template <class Visitor>
  static void for_faces(const Subdomain& domain, std::span<const std::uint8_t> turns, const Visitor& visit) {
    for (std::size_t face = 0; face < domain.boundary_faces.size(); ++face)
      if (turns[static_cast<std::size_t>(domain.boundary_faces[face].patch)]) visit(face);
  }

  Vec3 origin_;
  std::array<Vec3, 3> axes_;
  std::array<Real, 3> lower_, upper_;
};

void add(Symmetric3& sum, const Symmetric3& b) {
  sum.xx += b.xx;
  sum.xy += b.xy;
  sum.xz += b.xz;
  sum.yy += b.yy;
  sum.yz += b.yz;
  sum.zz += b.zz;
}

Real trace(const Symmetric3& a) {
  return a.xx + a.yy + a.zz;
}

/// What the boundary says of a point.
struct Marks {
  Symmetric3 fixed{}, symmetry{};  ///< sums of area times the square of the normal over the faces that stay
  Real turning = 0;                ///< number of faces that turn

  Marks& operator+=(const Marks& b) {
    add(fixed, b.fixed);
    add(symmetry, b.symmetry);
    turning += b.turning;
    return *this;
  }
};

/// [owned_points]
std::vector<Marks> marks_of(const Discretization& discretization, std::span<const std::uint8_t> turns,
                            const Communicator& comm) {
  const Subdomain& domain = discretization.domain();
  std::vector<Marks> marks(static_cast<std::size_t>(domain.owned_points));
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i) {
    const auto& face = domain.boundary_faces[i];
    const Vec3 area = domain.boundary_normal[i], root = 1 / std::sqrt(norm(area)) * area;
    for (const Index point : face.points) {
      Marks& here = marks[static_cast<std::size_t>(point)];
      if (turns[static_cast<std::size_t>(face.patch)]) {
        here.turning += 1;
        continue;
      }
      add_square(here.fixed, root);
      if (discretization.kind_of(face) == BoundaryKind::symmetry) add_square(here.symmetry, root);
    }
  }
  const std::span<const GlobalIndex> ids(domain.point_ids);
  return sum_at_points<Marks>(ids.first(marks.size()), marks, comm);
}

/// The part of u across a surface whose faces around a point have these squares of normals: across the one
/// side of a smooth surface, across both sides of an edge, all of it in a corner.
Vec3 across(const Symmetric3& a, const Vec3& u) {
  constexpr Real of_an_edge = 0.1;  // of the trace: sides that meet at more than 37 degrees
  if (trace(a) == 0) return {};
  Eigen::Matrix3d matrix;
  matrix << a.xx, a.xy, a.xz, a.xy, a.yy, a.yz, a.xz, a.yz, a.zz;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  Vec3 out;
  for (int i = 0; i < 3; ++i) {
    if (solver.eigenvalues()(i) < of_an_edge * trace(a)) continue;
    const auto column = solver.eigenvectors().col(i);
    const Vec3 direction{column(0), column(1), column(2)};
    out += dot(direction, u) * direction;
  }
  return out;
}

/// Means over the cells of what is kept at their corners, and over the points of what is kept in the cells
/// around, so many times, at points that are free: [owned_points], changed in place.
void smooth(const Subdomain& domain, const Communicator& comm, std::span<const std::uint8_t> is_free,
            std::vector<Vec3>& values) {
  constexpr int passes = 20;
  std::vector<Index> points, cells;
  std::vector<std::uint8_t> is_beside(static_cast<std::size_t>(domain.total_cells));
  for (Index point = 0; point < domain.owned_points; ++point) {
    if (!is_free[static_cast<std::size_t>(point)]) continue;
    points.push_back(point);
    for (const Index cell : domain.point_cells[point]) is_beside[static_cast<std::size_t>(cell)] = 1;
  }
  for (Index cell = 0; cell < domain.owned_cells; ++cell)
    if (is_beside[static_cast<std::size_t>(cell)]) cells.push_back(cell);
  CellField<Vec3> means(domain, comm);
  for (int pass = 0; pass < passes; ++pass) {
    for (const Index cell : cells) {
      means[cell] = {};
      for (const Index point : domain.cell_points[static_cast<std::size_t>(cell)])
        means[cell] += 0.25 * values[static_cast<std::size_t>(point)];
    }
    means.exchange();
    for (const Index point : points) {
      Vec3 sum;
      for (const Index cell : domain.point_cells[point]) sum += means[cell];
      values[static_cast<std::size_t>(point)] = 1 / static_cast<Real>(domain.point_cells[point].size()) * sum;
    }
  }
}

}  // namespace

Deflection deflection(const Discretization& discretization, std::span<const std::string> patches,
                      const Hinge& hinge, const Communicator& comm) {
  const Subdomain& domain = discretization.domain();
  std::vector<std::uint8_t> turns;
  for (const auto& patch : domain.patch_names)
    turns.push_back(std::ranges::find(patches, patch) != patches.end());

  const auto marks = marks_of(discretization, turns, comm);
  const HingedBox box(domain, turns, hinge, comm);
  const Real reach = 0.5 * box.diagonal();
  const auto owned = static_cast<std::size_t>(domain.owned_points);
  std::vector<Vec3> kept_back(owned), turned(owned);
  std::vector<std::uint8_t> is_free(owned);
  Deflection out;
  out.hinge_distance = box.hinge_distance() / box.diagonal();
  Real largest = 0;
  for (Index point = 0; point < domain.owned_points; ++point) {
    const auto at = static_cast<std::size_t>(point);
    const Marks& here = marks[at];
    const Vec3 x = domain.points[at];
    const bool is_turning = here.turning > 0;
    const Real share = is_turning ? 1 : blend(box.distance(x) / reach);
    turned[at] = share * cross(hinge.axis, x - hinge.point);
    kept_back[at] = across(here.fixed, turned[at]);
    is_free[at] = !is_turning && share > 0 && trace(here.fixed) == 0;
    if (!is_turning) continue;
    largest = std::max(largest, norm(turned[at]));
    out.lost_at_walls = std::max(out.lost_at_walls, norm(kept_back[at]));
    out.lost_at_symmetry = std::max(out.lost_at_symmetry, norm(across(here.symmetry, turned[at])));
  }
  std::array<Real, 3> most{largest, out.lost_at_walls, out.lost_at_symmetry};
  comm.max(std::span<Real>(most));
  if (most[0] > 0) out.lost_at_walls = most[1] / most[0], out.lost_at_symmetry = most[2] / most[0];

  smooth(domain, comm, is_free, kept_back);
  out.displacement.resize(domain.points.size());
  for (std::size_t point = 0; point < owned; ++point)
    out.displacement[point] = turned[point] - kept_back[point];
  if (comm.size() == 1) return out;
  CellField<std::array<Vec3, 4>> corners(domain, comm);  // for points of ghosts alone
  for (Index cell = 0; cell < domain.owned_cells; ++cell)
    for (std::size_t i = 0; i < 4; ++i)
      corners[cell][i] =
          out.displacement[static_cast<std::size_t>(domain.cell_points[static_cast<std::size_t>(cell)][i])];
  corners.exchange();
  for (Index cell = domain.owned_cells; cell < domain.total_cells; ++cell)
    for (std::size_t i = 0; i < 4; ++i)
      out.displacement[static_cast<std::size_t>(domain.cell_points[static_cast<std::size_t>(cell)][i])] =
          corners[cell][i];
  return out;
}

bool deflect(Subdomain& domain, Discretization& discretization, std::span<const std::string> patches,
             const Hinge& hinge, Real angle, const Communicator& comm) {
  constexpr Real largest_step = 0.01;  // of a rigid turn the midpoint rule leaves 1e-7
  const int steps = static_cast<int>(std::ceil(std::abs(angle) / largest_step));
  const auto move = [&](const std::vector<Vec3>& from, Real by) {
    const auto along = deflection(discretization, patches, hinge, comm).displacement;
    for (std::size_t point = 0; point < from.size(); ++point)
      domain.points[point] = from[point] + by * along[point];
    domain.update_metrics();
    discretization.update_geometry();
  };
  for (int step = 0; step < steps; ++step) {
    const auto before = domain.points;
    move(before, 0.5 * angle / steps);
    move(before, angle / steps);
    if (comm.any(std::ranges::min(domain.volume) <= 0)) return false;
  }
  return true;
}

}  // namespace alphadot
