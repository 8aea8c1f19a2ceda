// Reconstruction. Expectations: least squares is exact for linear fields; Green and Gauss's theorem, summed
// face by face; Barth & Jespersen's limiter makes no new extrema on faces, that of Park & Kim (MLP-u2) none
// at the points.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "space/reconstruction.hpp"
#include "support/box_case.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

constexpr Real round_off = 1e-12;  // slopes of order one over spacings of a quarter, fits of 60 cells

Vec3 slope_of(int i) {
  return {1.0 - 0.3 * i, 0.5 * i - 0.7, 0.2 + 0.1 * i * i};
}
Primitive<Real> linear_state(const Vec3& x) {
  Primitive<Real> w;
  for (int i = 0; i < 5; ++i) w[i] = 10 + i + dot(slope_of(i), x);
  return w;
}

struct Gradients {
  Gradients(const BoxSides& sides, const SpaceSettings& space, const Mesh& mesh = small_box())
      : box(mesh, sides, space, Communicator()),
        flow(box.domain, box.comm),
        reconstruction(box.discretization, box.comm) {}

  template <class State>
  void reconstruct(State&& state) {
    fill(flow, box.domain, state);
    reconstruction.update(flow, 2);
  }

  BoxCase box;
  FlowField<Real> flow;
  Reconstruction<Real> reconstruction;
};

void expect_linear(const Gradient<Real>& gradient) {
  for (int i = 0; i < 5; ++i)
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(gradient.along[axis][i], slope_of(i)[axis], round_off);
}

// Up to the boundary and in the ghosts across cut faces, which receive their owners' gradients.
TEST(Gradient, IsExactForLinearFields) {
  Gradients g(open_box(), {.limiter = LimiterKind::none});
  g.reconstruct([](const Vec3& x, GlobalIndex) { return linear_state(x); });
  for (Index cell = 0; cell < g.box.domain.owned_cells; ++cell) expect_linear(g.reconstruction[cell]);
  for (const auto& neighbour : g.box.domain.neighbours)
    for (Index i = 0; i < neighbour.ghost_face_count; ++i)
      expect_linear(g.reconstruction[neighbour.ghost_begin + i]);
}

TEST(Gradient, CarriesLinearStatesToFacesExactly) {
  Gradients g(open_box(), {.limiter = LimiterKind::none});
  g.reconstruct([](const Vec3& x, GlobalIndex) { return linear_state(x); });
  const Subdomain& domain = g.box.domain;
  for (std::size_t face = 0; face < domain.faces.size(); ++face)
    for (const Index cell : {domain.faces[face].left, domain.faces[face].right}) {
      const Vec3 at = domain.face_center[face];
      const auto found = extrapolated(g.flow[cell], g.reconstruction[cell], at - domain.center[cell]);
      for (int i = 0; i < 5; ++i) EXPECT_NEAR(found[i], linear_state(at)[i], round_off);
    }
}

// Rausch, Batina & Yang's values of points (1991) reproduce linear fields where cells lie all around, and so
// do integrals over faces of values that are linear on them. Near the boundary their weights are cut.
TEST(GreenGauss, IsExactForLinearFieldsInTheInterior) {
  Gradients g(open_box(), {.gradient = GradientKind::green_gauss, .limiter = LimiterKind::none});
  g.reconstruct([](const Vec3& x, GlobalIndex) { return linear_state(x); });
  const Subdomain& domain = g.box.domain;
  GlobalIndex interior = 0;
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    const bool is_interior = std::ranges::all_of(domain.cell_points[cell], [&](Index point) {
      const Vec3& p = domain.points[point];  // of the box from (-1, 0, 2) to (1, 1.2, 3)
      return std::abs(p.x) < 1 && p.y > 0 && p.y < 1.2 && p.z > 2 && p.z < 3;
    });
    if (!is_interior) continue;
    expect_linear(g.reconstruction[cell]);
    ++interior;
  }
  EXPECT_EQ(g.box.comm.sum(interior), 6 * 3 * 2 * 2);
}

// Of a field that is not linear, on a regular mesh: there the 24 cells around an inner point lie opposite
// each other, and the point's value is their mean. The integral of that over a cell's faces, by its volume.
TEST(GreenGauss, IsTheSurfaceIntegralOfMeansAroundPoints) {
  Gradients g(open_box(), {.gradient = GradientKind::green_gauss, .limiter = LimiterKind::none},
              box_mesh({.cells = {4, 4, 4}}));
  const auto curved = [](const Vec3& x) {
    Primitive<Real> w;
    for (int i = 0; i < 5; ++i) w[i] = 10 + x.x * x.x + (1 + i) * x.x * x.y - x.z * x.z * x.z;
    return w;
  };
  g.reconstruct([&](const Vec3& x, GlobalIndex) { return curved(x); });
  const Subdomain& domain = g.box.domain;
  const auto is_inner = [&](Index point) {
    const Vec3& p = domain.points[point];
    return p.x > 0 && p.x < 1 && p.y > 0 && p.y < 1 && p.z > 0 && p.z < 1;
  };
  const auto mean_around = [&](Index point, int i) {
    Real sum = 0;
    for (const Index cell : domain.point_cells[point]) sum += curved(domain.center[cell])[i];
    EXPECT_EQ(domain.point_cells[point].size(), 24u);
    return sum / 24;
  };
  GlobalIndex inner = 0;
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    if (!std::ranges::all_of(domain.cell_points[cell], is_inner)) continue;
    ++inner;
    for (int i = 0; i < 5; ++i) {
      Vec3 integral;
      for (const Index face : domain.cell_faces[cell]) {
        Real value = 0;
        for (const Index point : domain.face_points[face]) value += mean_around(point, i) / 3;
        const Real sign = domain.faces[face].left == cell ? 1 : -1;
        integral += sign * value * domain.face_normal[face];
      }
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(g.reconstruction[cell].along[axis][i], integral[axis] / domain.volume[cell], round_off);
    }
  }
  EXPECT_EQ(g.box.comm.sum(inner), 6 * 2 * 2 * 2);
}

// What is exact for linear fields, and for no others, is off by the first power of the spacing on a mesh
// without symmetry: cubes half as large, half the error, in the mean over the interior.
TEST(Gradient, IsOfFirstOrderOnMeshesWithoutSymmetry) {
  const auto curved = [](const Vec3& x) {
    Primitive<Real> w;
    for (int i = 0; i < 5; ++i) w[i] = 10 + std::sin(2 * x.x + i) * std::cos(x.y - 2 * x.z);
    return w;
  };
  const auto slope = [](const Vec3& x, int i) {
    const Real along = std::sin(2 * x.x + i), across = std::sin(x.y - 2 * x.z);
    return Vec3{2 * std::cos(2 * x.x + i) * std::cos(x.y - 2 * x.z), -along * across, 2 * along * across};
  };
  const auto error_on = [&](GradientKind kind, int cubes) {
    Gradients g(open_box(), {.gradient = kind, .limiter = LimiterKind::none},
                box_mesh({.cells = {cubes, cubes, cubes}, .perturbation = 0.12}));
    g.reconstruct([&](const Vec3& x, GlobalIndex) { return curved(x); });
    const Subdomain& domain = g.box.domain;
    Real square = 0, volume = 0;
    for (Index cell = 0; cell < domain.owned_cells; ++cell) {
      const Vec3& at = domain.center[cell];
      const auto inside = [](Real x) { return x > 0.25 && x < 0.75; };
      if (!inside(at.x) || !inside(at.y) || !inside(at.z)) continue;
      volume += domain.volume[cell];
      for (int i = 0; i < 5; ++i)
        for (int axis = 0; axis < 3; ++axis)
          square +=
              domain.volume[cell] * std::pow(g.reconstruction[cell].along[axis][i] - slope(at, i)[axis], 2);
    }
    return std::sqrt(g.box.comm.sum(square) / g.box.comm.sum(volume));
  };
  for (const GradientKind kind : {GradientKind::least_squares, GradientKind::green_gauss}) {
    const Real order = std::log2(error_on(kind, 8) / error_on(kind, 16));
    EXPECT_NEAR(order, 1, 0.15);
  }
}

// Cells in the edges between two walls are held at first order, all others are exact.
TEST(Gradient, VanishesInCellsWithTwoWallsOnly) {
  Gradients g(channel(), {.limiter = LimiterKind::none});
  g.reconstruct([](const Vec3& x, GlobalIndex) { return linear_state(x); });
  const Subdomain& domain = g.box.domain;
  std::vector<int> walls(g.box.cells(), 0);
  for (const auto& face : domain.boundary_faces)
    if (g.box.discretization.kind_of(face) == BoundaryKind::wall) ++walls[face.cell];
  Index flat = 0;
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    EXPECT_EQ(g.box.discretization.is_flat(cell), walls[cell] >= 2);
    if (walls[cell] < 2) {
      expect_linear(g.reconstruction[cell]);
      continue;
    }
    ++flat;
    for (const auto& along : g.reconstruction[cell].along)
      for (int i = 0; i < 5; ++i) EXPECT_EQ(along[i], 0);
  }
  EXPECT_GT(g.box.comm.sum(static_cast<GlobalIndex>(flat)), 0);
}

// By brute force over the cells around the points of each cell.
TEST(BarthJespersen, MakesNoNewExtremaOnFaces) {
  Gradients g(open_box(), {.limiter = LimiterKind::barth_jespersen});
  g.reconstruct(rough_state);
  const Subdomain& domain = g.box.domain;
  const auto expect_within = [&](Index cell, const Vec3& at) {
    const auto found = extrapolated(g.flow[cell], g.reconstruction[cell], at - domain.center[cell]);
    for (int i = 0; i < 5; ++i) {
      Real lowest = std::numeric_limits<Real>::max(), highest = -lowest;
      for (const Index point : domain.cell_points[cell])
        for (const Index other : domain.point_cells[point]) {
          lowest = std::min(lowest, g.flow[other][i]);
          highest = std::max(highest, g.flow[other][i]);
        }
      EXPECT_GE(found[i], lowest - 1e-14);
      EXPECT_LE(found[i], highest + 1e-14);
    }
  };
  for (std::size_t face = 0; face < domain.faces.size(); ++face)
    for (const Index cell : {domain.faces[face].left, domain.faces[face].right})
      if (cell < domain.owned_cells) expect_within(cell, domain.face_center[face]);
  for (std::size_t i = 0; i < domain.boundary_faces.size(); ++i)
    expect_within(domain.boundary_faces[i].cell, domain.boundary_center[i]);
}

// By brute force over the cells around each point, which is what sets this limiter apart: others look at the
// extrema around all points of a cell. The threshold is so low that no wiggle passes.
TEST(MlpU2, MakesNoNewExtremaAtPoints) {
  Gradients g(open_box(), {.limiter = LimiterKind::mlp_u2, .limiter_threshold = 1e-9});
  g.reconstruct(rough_state);
  const Subdomain& domain = g.box.domain;
  Real largest_share = 0;  // of the room towards an extremum that is used
  for (Index cell = 0; cell < domain.owned_cells; ++cell)
    for (const Index point : domain.cell_points[cell]) {
      const auto found =
          extrapolated(g.flow[cell], g.reconstruction[cell], domain.points[point] - domain.center[cell]);
      for (int i = 0; i < 5; ++i) {
        Real lowest = std::numeric_limits<Real>::max(), highest = -lowest;
        for (const Index other : domain.point_cells[point]) {
          lowest = std::min(lowest, g.flow[other][i]);
          highest = std::max(highest, g.flow[other][i]);
        }
        EXPECT_GE(found[i], lowest - 1e-14);
        EXPECT_LE(found[i], highest + 1e-14);
        const Real change = found[i] - g.flow[cell][i],
                   room = (change > 0 ? highest : lowest) - g.flow[cell][i];
        if (room != 0) largest_share = std::max(largest_share, change / room);
      }
    }
  // Venkatakrishnan's function is 3/4 where the change is as large as the room, and below 1 / (1 + y / 4).
  EXPECT_GT(g.box.comm.max(largest_share), 0.7);
}

// A linear field has its extrema at the farthest cells, beyond what the corners of a cell reach: the limiter
// leaves three quarters or more of it, and all of it below a threshold that lets everything pass.
TEST(MlpU2, LeavesWhatPassesWhole) {
  Gradients g(open_box(), {.limiter = LimiterKind::mlp_u2, .limiter_threshold = 1e3});
  g.reconstruct([](const Vec3& x, GlobalIndex) { return linear_state(x); });
  for (Index cell = 0; cell < g.box.domain.owned_cells; ++cell)
    for (int i = 0; i < 5; ++i)
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(g.reconstruction[cell].along[axis][i], slope_of(i)[axis], 1e-6);
}

// Every limiter multiplies a component of the unlimited gradient by one factor in [0, 1] per variable.
TEST(Limiters, ShortenTheGradientAlongItself) {
  Gradients free(open_box(), {.limiter = LimiterKind::none});
  free.reconstruct(rough_state);
  for (const LimiterKind limiter :
       {LimiterKind::venkatakrishnan, LimiterKind::mlp_u2, LimiterKind::barth_jespersen}) {
    Gradients limited(open_box(), {.limiter = limiter});
    limited.reconstruct(rough_state);
    GlobalIndex shortened = 0;
    for (Index cell = 0; cell < free.box.domain.owned_cells; ++cell)
      for (int i = 0; i < 5; ++i) {
        const auto part = [&](const Gradients& g) {
          const auto& along = g.reconstruction[cell].along;
          return Vec3{along[0][i], along[1][i], along[2][i]};
        };
        const Vec3 a = part(free), b = part(limited);
        EXPECT_NEAR(norm(cross(a, b)), 0, 1e-12);
        EXPECT_GE(dot(a, b), 0);
        EXPECT_LE(norm(b), norm(a) * (1 + 1e-13));
        if (norm(b) < 0.9 * norm(a)) ++shortened;
      }
    // Jumps of a few per cent from cell to cell are what Barth & Jespersen's limiter is for.
    const GlobalIndex everywhere = free.box.comm.sum(shortened);
    EXPECT_TRUE(everywhere > 0 || limiter != LimiterKind::barth_jespersen);
  }
}

}  // namespace
}  // namespace alphadot
