#include "solver/block_lu_sgs.hpp"

#include <algorithm>

#include "solver/jacobian.hpp"

namespace alphadot {

BlockLuSgs::BlockLuSgs(const Discretization& discretization, const Communicator& comm, int sweeps)
    : discretization_(discretization),
      sweeps_(sweeps),
      matrix_(discretization.domain()),
      update_(discretization.domain(), comm, HaloWidth::faces) {}

void BlockLuSgs::linearise(const FlowField<Real>& flow, const Conditions<Real>& conditions,
                           const TimeTerms& time) {
  assemble_jacobian(discretization_, flow, conditions, time, matrix_);
}

namespace {

/// y += sign * A x, column by column.
inline void multiply_add(float* y, const Block& a, const float* x, float sign) {
  for (int column = 0; column < 5; ++column)
    for (int row = 0; row < 5; ++row) y[row] += sign * a[5 * column + row] * x[column];
}

}  // namespace

void BlockLuSgs::sweep(Direction direction, std::span<const Conserved<Real>> residual) {
  const Index cells = discretization_.domain().owned_cells;
  for (Index i = 0; i < cells; ++i) {
    const Index row = direction == Direction::forward ? i : cells - 1 - i;
    float right[5];
    for (int k = 0; k < 5; ++k) right[k] = static_cast<float>(-residual[row][k]);
    const auto columns = matrix_.columns(row);
    const auto blocks = matrix_.blocks(row);
    for (std::size_t j = 0; j < columns.size(); ++j)
      multiply_add(right, blocks[j], update_[columns[j]].v, -1);
    SweepState next;
    multiply_add(next.v, matrix_.inverse_diagonal(row), right, 1);
    update_[row] = next;
  }
}

void BlockLuSgs::solve(std::span<const Conserved<Real>> residual, std::span<Primitive<Real>> update) {
  std::ranges::fill(update_.values(), SweepState{});
  for (int pass = 0; pass < sweeps_; ++pass) {
    if (pass > 0) update_.exchange();
    sweep(Direction::forward, residual);
    update_.exchange();
    sweep(Direction::backward, residual);
  }
  for (std::size_t cell = 0; cell < update.size(); ++cell)
    for (int k = 0; k < 5; ++k) update[cell][k] = update_[static_cast<Index>(cell)].v[k];
}

std::size_t BlockLuSgs::bytes() const {
  return matrix_.bytes() + update_.bytes();
}

}  // namespace alphadot
