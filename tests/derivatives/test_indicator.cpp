// What defects of the equations do to derivatives, and where the mesh's own are. The expected numbers are
// differences of derivatives about flows and responses that were solved for again with a defect planted, and
// the same numbers on another number of ranks.
#include "derivatives/indicator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>

#include "derivatives/sensitivity.hpp"
#include "linear/block_lu_sgs.hpp"
#include "space/dissipation.hpp"
#include "support/box_case.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

constexpr Real decades = 10, mach = 1.5;
const ConditionsChange plunge{{}, {0, 0, -mach}, {}}, pitch{{}, {}, {0, 1, 0}};

/// A smooth flow through a channel with the responses, adjoints and indicators of three derivatives of the
/// pitching moment. It is not steady, which none of the equations asks for, and no face lies along it, where
/// fluxes have kinks.
struct ChannelCase {
  explicit ChannelCase(const Communicator& comm)
      : box(small_box(), channel(),
            {.flux = FluxKind::van_leer, .limiter = LimiterKind::none, .freeze_orders = 0}, comm),
        iteration(box.discretization, box.comm, std::make_unique<BlockLuSgs>(box.discretization, box.comm, 3),
                  {}),
        moment(box.domain.patch_names.size(), Load{{}, {0, 1, 0}}) {
    fill(iteration.flow(), box.domain, [](const Vec3& x, GlobalIndex) { return wavy_state(x); });
    SensitivitySolver forward(iteration, conditions, settings);
    responses = forward.solve({{"alpha", plunge}, {"q", pitch}});
    responses.push_back(forward.solve({{"alphadot", {}, responses[0].field}})[0]);
    AdjointSolver backward(iteration, conditions, settings);
    adjoints = backward.solve({{"Cm", moment}});
    adjoints.push_back(backward.solve({{"Cm_alphadot", {}, adjoints[0].field}})[0]);
    chains = {{"Cm_alpha", moment, plunge, {responses[0].field}, {adjoints[0].field}},
              {"Cm_q", moment, pitch, {responses[1].field}, {adjoints[0].field}},
              {"Cm_alphadot",
               moment,
               plunge,
               {responses[0].field, responses[2].field},
               {adjoints[0].field, adjoints[1].field}}};
    found = indicators(iteration, conditions, backward, chains);
  }

  const Conditions<Real> conditions = steady_conditions({mach, 0, 0}, {}, gamma_air);
  const DerivativeSettings settings{.orders = decades, .max_iterations = 600};
  BoxCase box;
  ImplicitIteration iteration;
  std::vector<Load> moment;
  std::vector<Sensitivity> responses;
  std::vector<Adjoint> adjoints;
  std::vector<DerivativeChain> chains;
  std::vector<Indicator> found;
};

/// A defect without symmetry, the same on every partition.
Conserved<Real> planted(const Vec3& x, Real volume) {
  const Real s = std::sin(3 * x.x + x.z), c = std::cos(2 * x.x - 4 * x.z);
  return volume * Conserved<Real>{{s, 0.5 * c, 0, s * c, c - s}};
}

// The indicator's steps are large, of three thousandths, which leaves it as exact as that.
// The flow with a defect, to first order, on both sides of the flow without: its
// derivatives.
TEST(Indicator, KnowsWhatADefectOfTheSteadyFlowDoes) {
  const Communicator comm;
  ChannelCase channel_case(comm);
  ASSERT_EQ(channel_case.found.size(), 3);
  auto& flow = channel_case.iteration.flow();
  std::vector<Conserved<Real>> defect;
  for (Index cell = 0; cell < channel_case.box.domain.owned_cells; ++cell)
    defect.push_back(planted(channel_case.box.domain.center[cell], channel_case.box.domain.volume[cell]));
  const auto change =
      SensitivitySolver(channel_case.iteration, channel_case.conditions, channel_case.settings)
          .solve({{.name = "defect", .change = {}, .defect = defect}})[0]
          .field;
  constexpr Real step = 1e-4;
  const std::vector before(flow.values().begin(), flow.values().end());
  std::array<Real, 3> expected{};
  for (const Real side : {1, -1}) {
    for (Index cell = 0; cell < channel_case.box.domain.owned_cells; ++cell)
      flow[cell] = before[static_cast<std::size_t>(cell)] + side * step * change[cell];
    SensitivitySolver forward(channel_case.iteration, channel_case.conditions, channel_case.settings);
    const auto angles = forward.solve({{"alpha", plunge}, {"q", pitch}});
    const auto rate = forward.solve({{"alphadot", {}, angles[0].field}})[0];
    const Real moments[] = {angles[0].total.moment.y, angles[1].total.moment.y, rate.total.moment.y};
    for (std::size_t i = 0; i < 3; ++i) expected[i] += side / (2 * step) * moments[i];
  }
  for (std::size_t i = 0; i < 3; ++i) {
    Real sum = 0;
    for (std::size_t cell = 0; cell < defect.size(); ++cell)
      for (int k = 0; k < 5; ++k) sum -= channel_case.found[i].steady_adjoint[cell][k] * defect[cell][k];
    EXPECT_NEAR(comm.sum(sum), expected[i], 0.01 * std::abs(expected[i])) << channel_case.found[i].name;
  }
}

TEST(Indicator, IsTheSameOnAnyNumberOfRanks) {
  const Communicator comm, alone(MPI_COMM_SELF);
  const ChannelCase shared(comm), single(alone);
  const auto by_id = [](const ChannelCase& of, const Communicator& ranks) {
    std::vector<Real> out(static_cast<std::size_t>(of.box.domain.global_cells), 0);
    const auto all = joined(of.found, ranks);
    for (std::size_t cell = 0; cell < all.size(); ++cell)
      out[static_cast<std::size_t>(of.box.domain.cell_ids[cell])] = all[cell];
    ranks.sum(out);
    return out;
  };
  const auto a = by_id(shared, comm), b = by_id(single, alone);
  const Real largest = *std::ranges::max_element(b);
  EXPECT_NEAR(std::accumulate(b.begin(), b.end(), Real{0}), 1, 1e-12);
  for (std::size_t id = 0; id < a.size(); ++id) EXPECT_NEAR(a[id], b[id], 1e-5 * largest) << id;
}

// Between equal states there is none; between unequal ones Roe's is that of the characteristic waves: in
// supersonic flow along the normal the flux is that of the left state, half the difference of the fluxes from
// their mean.
TEST(Dissipation, IsTheFluxBeyondTheMean) {
  const Communicator comm;
  const BoxCase box(small_box(), open_box(), {.order = 1}, comm);
  FlowField<Real> flow(box.domain, comm);
  Reconstruction<Real> reconstruction(box.discretization, comm);
  const Conditions<Real> still{free_stream(Vec3{5, 0, 0}, gamma_air), {}};
  const auto of = [&](auto&& state) {
    fill(flow, box.domain, state);
    reconstruction.update(flow, 1);
    return dissipation(box.discretization, flow, reconstruction, still);
  };
  for (const auto& face : of([&](const Vec3&, GlobalIndex) { return still.free_stream; }))
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(face[i], 0, 1e-13);
  const auto rough = of([&](const Vec3& x, GlobalIndex id) {
    auto w = rough_state(x, id);
    w[1] += 3.5;
    return w;
  });
  int supersonic = 0;
  for (std::size_t face = 0; face < rough.size(); ++face) {
    const auto& area = box.domain.face_normal[face];
    if (std::abs(area.x) < 0.9 * norm(area)) continue;
    ++supersonic;
    const auto [left, right] = box.domain.faces[face];
    const Vec3 normal = (1 / norm(area)) * area;
    const Real side = area.x > 0 ? 0.5 : -0.5;
    const auto expected = side * norm(area) *
                          (physical_flux(flow[left], normal, Real{0}, gamma_air) -
                           physical_flux(flow[right], normal, Real{0}, gamma_air));
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(rough[face][i], expected[i], 1e-12);
  }
  EXPECT_GT(comm.sum(static_cast<Real>(supersonic)), 5);
}

}  // namespace
}  // namespace alphadot
