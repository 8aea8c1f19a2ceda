// The derivative of the second-order residual, against central differences of the residual itself and on a
// uniform stream, where it is known.
#include "linear/tangent.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/box_case.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

// Small: limiters and fluxes have kinks, which a large step would straddle somewhere. Round-off 1e-16 / step
// = 1e-9, what is compared up to 1.6: seven digits with room to spare.
constexpr Real step = 1e-7, tolerance = 1e-8;
const Vec3 center{0.3, -0.1, 0.4};

/// Every kind of boundary.
constexpr BoxSides all_sides{BoundaryKind::farfield, BoundaryKind::farfield, BoundaryKind::wall,
                             BoundaryKind::symmetry, BoundaryKind::jet,      BoundaryKind::sting};

const ConditionsChange changes[3] = {{{0.5, -0.3, 0.8}, {}, {}},
                                     {{}, {-0.4, 0.2, 0.9}, {0.3, -0.7, 0.2}},
                                     {{0.1, 0.2, -0.3}, {0.2, 0.1, -0.5}, {-0.4, 0.1, 0.6}}};

/// A direction in the space of flows, the same on every partition.
std::vector<Primitive<Real>> direction(const BoxCase& box, int k) {
  std::vector<Primitive<Real>> out(box.cells());
  for (Index cell = 0; cell < box.domain.owned_cells; ++cell)
    for (int i = 0; i < 5; ++i)
      out[cell][i] = std::sin(7.0 * static_cast<Real>(box.domain.cell_ids[cell]) + 3 * i + k);
  return out;
}

/// Residual and loads at a flow and conditions moved along one direction. The limiter follows, or is frozen
/// at what it was before.
struct Moved {
  Moved(const BoxCase& box, const Conditions<Real>& base, const std::vector<Primitive<Real>>& field,
        const ConditionsChange& change, Real share, bool limiter_held)
      : values(box.cells()) {
    FlowField<Real> flow(box.domain, box.comm);
    fill(flow, box.domain, rough_state);
    Residual residual(box.discretization, box.comm);
    if (limiter_held) {
      residual.evaluate(flow, base, 2, values);
      residual.freeze_limiter(true);
    }
    for (std::size_t i = 0; i < field.size(); ++i) flow[static_cast<Index>(i)] += share * field[i];
    const Vec3 wind = velocity(base.free_stream) + share * change.wind;
    const Conditions<Real> conditions{free_stream(wind, gamma_air),
                                      {base.grid.velocity + share * change.grid_velocity,
                                       base.grid.rotation + share * change.rotation, base.grid.axis},
                                      wind};
    residual.evaluate(flow, conditions, 2, values);
    loads = wall_loads(box.discretization, residual, center);
  }
  std::vector<Conserved<Real>> values;
  std::vector<Load> loads;
};

class TangentTest : public testing::TestWithParam<std::tuple<FluxKind, LimiterKind>> {};
INSTANTIATE_TEST_SUITE_P(Schemes, TangentTest,
                         testing::Combine(testing::ValuesIn(all_fluxes),
                                          testing::Values(LimiterKind::none, LimiterKind::venkatakrishnan,
                                                          LimiterKind::mlp_u2,
                                                          LimiterKind::barth_jespersen)));

/// All three directions at once: flow and conditions, about a grid that moves.
void expect_central_differences(const SpaceSettings& space, bool limiter_held, Real allowed) {
  const BoxCase box(small_box(), all_sides, space, Communicator(), Dissipative::some);
  FlowField<Real> flow(box.domain, box.comm);
  fill(flow, box.domain, rough_state);
  const Vec3 wind{1.5, 0.1, -0.2};
  const Conditions<Real> conditions{free_stream(wind, gamma_air), tumbling_grid(), wind};

  std::vector<Conserved<Real>> values(box.cells());
  Residual residual(box.discretization, box.comm);
  residual.evaluate(flow, conditions, 2, values);
  Linearisation linearisation(box.discretization, box.comm, flow, residual.reconstruction(), conditions);
  if (limiter_held) linearisation.hold_limiter();
  Tangent<3> tangent(linearisation, center);
  std::array<std::vector<Primitive<Real>>, 3> fields;
  std::array<std::vector<Conserved<Real>>, 3> images;
  for (int k = 0; k < 3; ++k) {
    fields[k] = direction(box, k);
    images[k].resize(box.cells());
  }
  tangent.apply({fields[0], fields[1], fields[2]}, {changes[0], changes[1], changes[2]},
                {images[0], images[1], images[2]});
  const auto loads = tangent.loads();

  for (int k = 0; k < 3; ++k) {
    const Moved above(box, conditions, fields[k], changes[k], step, limiter_held),
        below(box, conditions, fields[k], changes[k], -step, limiter_held);
    for (std::size_t cell = 0; cell < box.cells(); ++cell)
      for (int i = 0; i < 5; ++i)
        EXPECT_NEAR(images[k][cell][i], (above.values[cell][i] - below.values[cell][i]) / (2 * step), allowed)
            << "direction " << k << " entry " << i;
    for (std::size_t patch = 0; patch < loads[k].size(); ++patch) {
      const Load difference = (0.5 / step) * (above.loads[patch] - below.loads[patch]);
      EXPECT_NEAR(norm(loads[k][patch].force - difference.force), 0, allowed);
      EXPECT_NEAR(norm(loads[k][patch].moment - difference.moment), 0, allowed);
    }
  }
}

TEST_P(TangentTest, AgreesWithCentralDifferences) {
  const auto [kind, limiter] = GetParam();
  expect_central_differences({.flux = kind, .order = 2, .limiter = limiter}, false, tolerance);
}

// Frozen factors are kept in single precision.
TEST_P(TangentTest, AgreesWithThoseOfAFrozenLimiterWhenItIsHeld) {
  constexpr Real single_precision = 6e-8;
  const auto [kind, limiter] = GetParam();
  expect_central_differences({.flux = kind, .order = 2, .limiter = limiter}, true, 2 * single_precision);
}

// A uniform stream stays a solution when it changes as a whole, when the grid moves through it and when both
// turn together: nothing is left, exactly.
TEST_P(TangentTest, VanishesForChangesOfTheWholeStream) {
  const auto [kind, limiter] = GetParam();
  const BoxCase box(small_box(), open_box(), {.flux = kind, .order = 2, .limiter = limiter}, Communicator());
  const Vec3 wind{1.5, 0.1, -0.2};
  const auto conditions = steady_conditions(wind, {0.4, -0.6, 0.2}, gamma_air);
  FlowField<Real> flow(box.domain, box.comm);
  fill(flow, box.domain, [&](const Vec3&, GlobalIndex) { return conditions.free_stream; });
  std::vector<Conserved<Real>> values(box.cells());
  Residual residual(box.discretization, box.comm);
  residual.evaluate(flow, conditions, 2, values);
  const Linearisation linearisation(box.discretization, box.comm, flow, residual.reconstruction(),
                                    conditions);
  Tangent<1> tangent(linearisation, center);
  for (const auto& change : changes) {
    const Primitive<Real> turn{{0, change.wind.x, change.wind.y, change.wind.z, 0}};
    const std::vector<Primitive<Real>> field(box.cells(), turn);
    std::vector<Conserved<Real>> image(box.cells());
    tangent.apply({field}, {change}, {image});
    for (const auto& value : image)
      for (const Real entry : value.v) EXPECT_NEAR(entry, 0, 1e-12);
  }
}

}  // namespace
}  // namespace alphadot
