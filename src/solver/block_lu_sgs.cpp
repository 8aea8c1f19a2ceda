#include "solver/block_lu_sgs.hpp"

#include <algorithm>
#include <experimental/simd>

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

using Lanes = std::experimental::fixed_size_simd<float, 8>;

/// y + A x, column by column. A column is loaded with the three numbers behind it, which land in unused
/// lanes.
inline Lanes multiply_add(Lanes y, const Block& a, const float* x) {
  for (int column = 0; column < 5; ++column)
    y += Lanes(&a[5 * column], std::experimental::element_aligned) * Lanes(x[column]);
  return y;
}

}  // namespace

void BlockLuSgs::sweep(Direction direction, std::span<const Conserved<Real>> residual) {
  const Index cells = discretization_.domain().owned_cells;
  for (Index i = 0; i < cells; ++i) {
    const Index row = direction == Direction::forward ? i : cells - 1 - i;
    const auto columns = matrix_.columns(row);
    const auto blocks = matrix_.blocks(row);
    Lanes sums[2] = {0, 0};  // two, so that one product need not wait for the other
    for (std::size_t j = 0; j < columns.size(); ++j)
      sums[j % 2] = multiply_add(sums[j % 2], blocks[j], update_[columns[j]].v);
    SweepState right;
    (sums[0] + sums[1]).copy_to(right.v, std::experimental::vector_aligned);
    for (int k = 0; k < 5; ++k) right.v[k] = -static_cast<float>(residual[row][k]) - right.v[k];
    multiply_add(0, matrix_.inverse_diagonal(row), right.v)
        .copy_to(update_[row].v, std::experimental::vector_aligned);
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
