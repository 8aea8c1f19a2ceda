// The residual does not depend on how the mesh is cut: every rank compares its cells with those of the whole
// mesh on itself alone. Sums of a few terms in another order: 1e-13 of the largest residual.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "space/residual.hpp"
#include "support/box_case.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

std::vector<Five<Real>> residual_of(const BoxCase& box, const Conditions<Real>& conditions, int order) {
  FlowField<Real> flow(box.domain, box.comm);
  fill(flow, box.domain, rough_state);
  std::vector<Conserved<Real>> values(box.cells());
  Residual(box.discretization, box.comm).evaluate(flow, conditions, order, values);
  return by_cell_id(box.domain, box.comm, values);
}

class Partitions : public testing::TestWithParam<std::tuple<FluxKind, LimiterKind, int>> {};
INSTANTIATE_TEST_SUITE_P(Schemes, Partitions,
                         testing::Combine(testing::ValuesIn(all_fluxes),
                                          testing::Values(LimiterKind::none, LimiterKind::venkatakrishnan,
                                                          LimiterKind::barth_jespersen),
                                          testing::Values(1, 2)));

TEST_P(Partitions, GiveTheSameResidual) {
  const auto [kind, limiter, order] = GetParam();
  const SpaceSettings space{.flux = kind, .order = order, .limiter = limiter};
  const Mesh mesh = small_box();
  const BoxCase cut(mesh, channel(), space, Communicator()),
      whole(mesh, channel(), space, Communicator(MPI_COMM_SELF));
  const Conditions<Real> conditions{free_stream(Vec3{1.5, 0.1, -0.2}, gamma_air), tumbling_grid()};
  const auto found = residual_of(cut, conditions, order), expected = residual_of(whole, conditions, order);
  Real largest = 0;
  for (const auto& value : expected)
    for (const Real entry : value.v) largest = std::max(largest, std::abs(entry));
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t cell = 0; cell < found.size(); ++cell)
    for (int i = 0; i < 5; ++i)
      EXPECT_NEAR(found[cell][i], expected[cell][i], 1e-13 * largest) << "cell " << cell;
}

}  // namespace
}  // namespace alphadot
