// The transpose of the tangent. The expected number is the definition: whatever the adjoints y and the
// weights of the loads, y . (A x + R_c c) + weights . (loads of x and c) = x . (transpose's flow) + c .
// (transpose's conditions), the left side by Tangent, which central differences prove.
#include "linear/tangent_transpose.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "march/turning.hpp"
#include "support/box_case.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

constexpr Real round_off = 1e-12;
const Vec3 center{0.3, -0.1, 0.4};

/// Every kind of boundary.
constexpr BoxSides all_sides{BoundaryKind::farfield, BoundaryKind::wall, BoundaryKind::wall,
                             BoundaryKind::symmetry, BoundaryKind::jet,  BoundaryKind::sting};

/// Numbers without a pattern, the same on every partition.
Real scatter(GlobalIndex id, int i, int k) {
  return std::sin(7.0 * static_cast<Real>(id) + 3 * i + 11 * k);
}
Vec3 scatter3(int k) {
  return {scatter(1, 0, k), scatter(2, 1, k), scatter(3, 2, k)};
}
std::vector<Five<Real>> scattered(const BoxCase& box, int k) {
  std::vector<Five<Real>> out(box.cells());
  for (Index cell = 0; cell < box.domain.owned_cells; ++cell)
    for (int i = 0; i < 5; ++i) out[cell][i] = scatter(box.domain.cell_ids[cell], i, k);
  return out;
}
std::vector<Load> scattered_weights(const BoxCase& box, int k) {
  std::vector<Load> out;
  for (int patch = 0; patch < static_cast<int>(box.domain.patch_names.size()); ++patch)
    out.push_back({scatter3(k + 2 * patch), scatter3(k + 2 * patch + 1)});
  return out;
}

Real product(std::span<const Five<Real>> a, std::span<const Five<Real>> b) {
  Real sum = 0;
  for (std::size_t cell = 0; cell < a.size(); ++cell)
    for (int i = 0; i < 5; ++i) sum += a[cell][i] * b[cell][i];
  return sum;
}
Real product(std::span<const Load> a, std::span<const Load> b) {
  Real sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += dot(a[i].force, b[i].force) + dot(a[i].moment, b[i].moment);
  return sum;
}
Real product(const ConditionsChange& a, const ConditionsChange& b) {
  return dot(a.wind, b.wind) + dot(a.grid_velocity, b.grid_velocity) + dot(a.rotation, b.rotation);
}

/// A linearisation about the rough flow and a grid that tumbles, or rests, with walls that have turned by
/// this angle.
struct Linearised {
  Linearised(const SpaceSettings& space, bool tumbles, Real turn = 0)
      : box(small_box(), all_sides, space, Communicator(), Dissipative::some),
        flow(box.domain, box.comm),
        conditions{free_stream(wind, gamma_air), tumbles ? tumbling_grid() : GridMotion<Real>{}, wind},
        residual(box.discretization, box.comm) {
    if (turn != 0) {
      const std::vector<std::string> patches{box.domain.patch_names[1], box.domain.patch_names[5]};
      box.discretization.set_turned_walls(
          turned_further(box.discretization, patches, {{0.9, 0.2, 2.3}, {0.6, 0, 0.8}}, turn, 0.3));
    }
    fill(flow, box.domain, rough_state);
    std::vector<Conserved<Real>> values(box.cells());
    residual.evaluate(flow, conditions, space.order, values);
    linearisation.emplace(box.discretization, box.comm, flow, residual.reconstruction(), conditions);
  }
  const Vec3 wind{1.5, 0.1, -0.2};
  BoxCase box;
  FlowField<Real> flow;
  Conditions<Real> conditions;
  Residual residual;
  std::optional<Linearisation> linearisation;
};

/// Which parts of the two sides are not zero.
struct Parts {
  bool flow = true, conditions = true, residual = true, loads = true;
};

template <int N>
void expect_the_same_products(const Linearised& about, const Parts& parts) {
  const BoxCase& box = about.box;
  Tangent<N> tangent(*about.linearisation, center);
  TangentTranspose<N> transpose(*about.linearisation, center);
  std::array<std::vector<Five<Real>>, N> x, y, image, sensitivity;
  std::array<ConditionsChange, N> changes;
  std::array<std::vector<Load>, N> weights;
  typename Tangent<N>::Fields fields;
  typename Tangent<N>::Images images;
  typename TangentTranspose<N>::Adjoints adjoints;
  typename TangentTranspose<N>::Images sensitivities;
  typename TangentTranspose<N>::Weights load_weights;
  for (std::size_t k = 0; k < N; ++k) {
    const int n = static_cast<int>(k);
    x[k] = parts.flow ? scattered(box, n) : std::vector<Five<Real>>(box.cells());
    y[k] = parts.residual ? scattered(box, 5 + n) : std::vector<Five<Real>>(box.cells());
    if (parts.conditions) changes[k] = {scatter3(n), scatter3(n + 3), scatter3(n + 6)};
    if (parts.loads) weights[k] = scattered_weights(box, n);
    image[k].resize(box.cells());
    sensitivity[k].resize(box.cells());
    fields[k] = x[k];
    images[k] = image[k];
    adjoints[k] = y[k];
    sensitivities[k] = sensitivity[k];
    load_weights[k] = weights[k];
  }
  tangent.apply(fields, changes, images);
  const auto loads = tangent.loads();
  transpose.apply(adjoints, load_weights, sensitivities);
  const auto by_conditions = transpose.conditions(load_weights);
  for (std::size_t k = 0; k < N; ++k) {
    const std::span<const Load> of_loads = loads[k];
    const Real there =
        box.comm.sum(product(y[k], image[k]) + (parts.loads ? product(weights[k], of_loads) : 0));
    const Real back = box.comm.sum(product(x[k], sensitivity[k]) + product(changes[k], by_conditions[k]));
    EXPECT_NEAR(back, there, round_off * std::abs(there)) << "functional " << k;
    EXPECT_NE(there, 0);
  }
}

using Scheme = std::tuple<FluxKind, GradientKind, LimiterKind, bool>;
class TangentTransposeTest : public testing::TestWithParam<Scheme> {
 protected:
  SpaceSettings space() const {
    const auto [flux, gradient, limiter, tumbles] = GetParam();
    return {.flux = flux, .gradient = gradient, .limiter = limiter};
  }
  bool tumbles() const { return std::get<3>(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Schemes, TangentTransposeTest,
                         testing::Combine(testing::ValuesIn(all_fluxes),
                                          testing::Values(GradientKind::least_squares,
                                                          GradientKind::green_gauss),
                                          testing::Values(LimiterKind::none, LimiterKind::venkatakrishnan,
                                                          LimiterKind::mlp_u2, LimiterKind::barth_jespersen),
                                          testing::Bool()));

TEST_P(TangentTransposeTest, GivesTheSameProducts) {
  const Linearised about(space(), tumbles());
  expect_the_same_products<3>(about, {});
  expect_the_same_products<1>(about, {.conditions = false, .loads = false});
  expect_the_same_products<1>(about, {.flow = false, .loads = false});
  expect_the_same_products<1>(about, {.conditions = false, .residual = false});
  expect_the_same_products<2>(about, {.flow = false, .residual = false});
}

TEST_P(TangentTransposeTest, GivesTheSameProductsWhenTheLimiterIsHeld) {
  Linearised about(space(), tumbles());
  about.linearisation->hold_limiter();
  expect_the_same_products<2>(about, {});
}

TEST_P(TangentTransposeTest, GivesTheSameProductsWhereWallsHaveTurned) {
  const Linearised about(space(), tumbles(), 0.1);
  expect_the_same_products<3>(about, {});
  expect_the_same_products<1>(about, {.conditions = false, .residual = false});
}

TEST_P(TangentTransposeTest, GivesTheSameProductsOfFirstOrder) {
  SpaceSettings first = space();
  first.order = 1;
  expect_the_same_products<1>(Linearised(first, tumbles()), {});
}

}  // namespace
}  // namespace alphadot
