// Blocks of the first-order Jacobian against central differences of the whole residual: rows of the interior,
// of the boundary and along cuts between ranks. Blocks are stored in single precision: 6e-8 of an entry, one
// part in a million is allowed.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "linear/jacobian.hpp"
#include "support/linearised.hpp"

namespace alphadot {
namespace {

using namespace testing_support;

constexpr Real single = 1e-6;
constexpr Real no_pseudo_time = 1e30;  // CFL number

template <class Entries>
Real largest_magnitude(const Entries& entries) {
  Real out = 0;
  for (const auto entry : entries) out = std::max(out, std::abs(static_cast<Real>(entry)));
  return out;
}

class Jacobian : public testing::TestWithParam<FluxKind> {
 protected:
  Jacobian() : flow(box.domain, box.comm), matrix(box.domain) {
    fill(flow, box.domain, rough_state);
    flow.exchange();
  }

  /// Derivative of the residual of all owned cells by entry `column` of one cell, wherever that is.
  std::vector<Conserved<Real>> column_of(FirstOrder& operator_, GlobalIndex id, int column) {
    std::vector<Primitive<Real>> direction(box.cells());
    for (Index cell = 0; cell < box.domain.owned_cells; ++cell)
      if (box.domain.cell_ids[cell] == id) direction[cell][column] = 1;
    return operator_.derivative(flow, direction);
  }

  const BoxCase box{
      small_box(), channel(), {.flux = GetParam(), .order = 1}, Communicator(), Dissipative::some};
  const Conditions<Real> conditions{free_stream(Vec3{1.5, 0.1, -0.2}, gamma_air), tumbling_grid()};
  FlowField<Real> flow;
  BlockMatrix matrix;
};
INSTANTIATE_TEST_SUITE_P(Fluxes, Jacobian, testing::ValuesIn(all_fluxes),
                         [](const auto& kind) { return name_of(kind.param); });

// Every 37th cell of 480 is moved: their neighbours' rows see off-diagonal blocks, their own the diagonal
// ones; rows further away must not move at all. 37 and 480 have no common factor, so that all kinds of cells
// come up.
TEST_P(Jacobian, HoldsTheDerivativesOfTheResidual) {
  constexpr Real inverse_step = 0.7;
  assemble_jacobian(box.discretization, flow, conditions,
                    {.cfl = no_pseudo_time, .inverse_step = inverse_step}, matrix);
  FirstOrder first_order(box, conditions);
  Real checked = 0;
  for (GlobalIndex id = 0; id < box.domain.global_cells; id += 37)
    for (int column = 0; column < 5; ++column) {
      const auto difference = column_of(first_order, id, column);
      for (Index row = 0; row < box.domain.owned_cells; ++row) {
        const auto columns = matrix.columns(row);
        const auto found = std::find_if(columns.begin(), columns.end(),
                                        [&](Index cell) { return box.domain.cell_ids[cell] == id; });
        if (box.domain.cell_ids[row] == id) {
          // What the inverse makes of the column of the diagonal block is a column of the identity.
          Primitive<Real> unit;
          unit[column] = 1;
          const auto diagonal =
              difference[row] + box.domain.volume[row] * inverse_step * conserved_change(flow[row], unit);
          const Block& inverse = matrix.inverse_diagonal(row);
          for (int i = 0; i < 5; ++i) {
            Real product = 0, size = 1;
            for (int k = 0; k < 5; ++k) {
              product += inverse[5 * k + i] * diagonal[k];
              size += std::abs(inverse[5 * k + i] * diagonal[k]);
            }
            EXPECT_NEAR(product, i == column, single * size);
          }
          ++checked;
        } else if (found != columns.end()) {
          const Block& block = matrix.blocks(row)[static_cast<std::size_t>(found - columns.begin())];
          const Real size = largest_magnitude(block);
          for (int i = 0; i < 5; ++i)
            EXPECT_NEAR(block[5 * column + i], difference[row][i], single * (0.1 + size));
          ++checked;
        } else {
          for (int i = 0; i < 5; ++i) EXPECT_EQ(difference[row][i], 0);
        }
      }
    }
  EXPECT_GT(box.comm.sum(checked), 5 * 13 * 3) << "13 cells with two neighbours or more each";
}

// At a small CFL number the diagonal block is the pseudo time term V / dtau dU/dW alone: its inverse halves
// with the CFL number, and turns the change of U that goes with density alone back into density alone.
TEST_P(Jacobian, IsDominatedByPseudoTimeAtSmallCfl) {
  BlockMatrix half(box.domain);
  assemble_jacobian(box.discretization, flow, conditions, {.cfl = 2e-7}, matrix);
  assemble_jacobian(box.discretization, flow, conditions, {.cfl = 1e-7}, half);
  for (Index row = 0; row < box.domain.owned_cells; ++row) {
    const Block &a = matrix.inverse_diagonal(row), &b = half.inverse_diagonal(row);
    const Real size = largest_magnitude(a);
    for (int i = 0; i < 25; ++i) EXPECT_NEAR(a[i], 2 * b[i], 2 * single * size);
    Primitive<Real> unit;
    unit[0] = 1;
    const auto du = conserved_change(flow[row], unit);
    for (int i = 1; i < 5; ++i) {
      Real product = 0;
      for (int k = 0; k < 5; ++k) product += a[5 * k + i] * du[k];
      EXPECT_NEAR(product, 0, 10 * single * size);
    }
  }
}

TEST(Inverse, GivesTheIdentity) {
  std::array<Real, 25> a{};
  for (int i = 0; i < 25; ++i) a[i] = std::sin(3.0 * i * i) + (i % 6 == 0 ? 3 : 0);
  const auto b = inverse(a);
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 5; ++column) {
      Real product = 0;
      for (int k = 0; k < 5; ++k) product += a[5 * k + row] * b[5 * column + k];
      EXPECT_NEAR(product, row == column, 1e-14);
    }
}

}  // namespace
}  // namespace alphadot
