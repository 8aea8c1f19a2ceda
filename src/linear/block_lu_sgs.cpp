#include "linear/block_lu_sgs.hpp"

#include <algorithm>

#include "linear/jacobian.hpp"

namespace alphadot {

namespace {
constexpr std::size_t most_together = 4;  // right-hand sides whose sums stay in registers
constexpr Index rows_ahead = 6;           // of a sweep, that the memory is asked for
}  // namespace

BlockLuSgs::System::System(const Subdomain& domain, const Communicator& comm)
    : right(static_cast<std::size_t>(domain.owned_cells)), update(domain, comm, HaloWidth::faces) {}

PassOrder pass_order(Real mach_along_x) {
  // On the Basic Finner alternating passes take 193 iterations to six decades at Mach 1.05, 82 at 1.2;
  // downstream ones more than 200, and 70.
  constexpr Real mostly_supersonic = 1.1;
  return mach_along_x < mostly_supersonic ? PassOrder::alternating : PassOrder::downstream;
}

int pass_pairs(PassOrder order, bool is_steady) {
  return is_steady && order == PassOrder::alternating ? 16 : 4;
}

BlockLuSgs::BlockLuSgs(const Discretization& discretization, const Communicator& comm, int sweeps,
                       PassOrder order)
    : discretization_(discretization),
      comm_(comm),
      asked_sweeps_(sweeps),
      sweeps_(sweeps),
      order_(order),
      matrix_(discretization.domain()) {
  systems_.push_back(std::make_unique<System>(discretization.domain(), comm));
}

void BlockLuSgs::linearise(const FlowField<Real>& flow, const Conditions<Real>& conditions,
                           const TimeTerms& time) {
  assemble_jacobian(discretization_, flow, conditions, time, matrix_);
  matrix_.scale_rows();
  is_transposed_ = false;
  sweeps_ = asked_sweeps_ > 0 ? asked_sweeps_ : pass_pairs(order_, time.inverse_step == 0);
}

void BlockLuSgs::transpose() {
  matrix_.transpose(discretization_.domain(), comm_);
  is_transposed_ = !is_transposed_;
}

template <int N>
void BlockLuSgs::sweep(Direction direction, Index begin, Index end) {
  SweepState* update[N];
  const SweepState* right[N];
  for (std::size_t k = 0; k < N; ++k) {
    update[k] = systems_[k]->update.data();
    right[k] = systems_[k]->right.data();
  }
  for (Index i = 0; i < end - begin; ++i) {
    const Index row = direction == Direction::forward ? begin + i : end - 1 - i;
    matrix_.prefetch(direction == Direction::forward ? row + rows_ahead : row - rows_ahead);
    const auto& columns = matrix_.columns(row);
    const auto& blocks = matrix_.blocks(row);
    for (std::size_t k = 0; k < N; ++k) {
      Lanes products[BlockMatrix::neighbours];  // apart, so that none waits for another
      for (std::size_t j = 0; j < columns.size(); ++j)
        products[j] = multiply_add(0, blocks[j], update[k][columns[j]].v);
      const Lanes sum = (products[0] + products[1]) + (products[2] + products[3]);
      (Lanes(right[k][row].v, std::experimental::vector_aligned) - sum)
          .copy_to(update[k][row].v, std::experimental::vector_aligned);
    }
  }
}

BlockLuSgs::Direction BlockLuSgs::direction(int pass) const {
  // The transpose of a pass over rows i < j goes from j to i, and the last pass's comes first.
  const int of_solve = is_transposed_ ? 2 * sweeps_ - 1 - pass : pass;
  const bool is_backward = order_ == PassOrder::alternating ? of_solve % 2 == 1 : of_solve == sweeps_;
  return is_backward != is_transposed_ ? Direction::backward : Direction::forward;
}

template <int N>
void BlockLuSgs::solve_together(std::span<const LinearSystem> systems) {
  const Index interior = discretization_.domain().interior_cells,
              cells = discretization_.domain().owned_cells;
  const auto start_exchange = [&] {
    for (std::size_t k = 0; k < N; ++k) systems_[k]->update.start_exchange();
  };
  const auto finish_exchange = [&] {
    for (std::size_t k = 0; k < N; ++k) systems_[k]->update.finish_exchange();
  };
  for (std::size_t k = 0; k < N; ++k) {
    std::ranges::fill(systems_[k]->update.values(), SweepState{});
    for (std::size_t row = 0; row < systems_[k]->right.size(); ++row) {
      float minus_residual[5];
      for (int i = 0; i < 5; ++i) minus_residual[i] = -static_cast<float>(systems[k].residual[row][i]);
      if (is_transposed_)
        std::copy_n(minus_residual, 5, systems_[k]->right[row].v);
      else
        multiply_add(0, matrix_.inverse_diagonal(static_cast<Index>(row)), minus_residual)
            .copy_to(systems_[k]->right[row].v, std::experimental::vector_aligned);
    }
  }
  const int passes = 2 * sweeps_;
  for (int pass = 0; pass < passes; ++pass) {
    const bool is_first = pass == 0, is_last = pass + 1 == passes;
    if (direction(pass) == Direction::forward) {
      sweep<N>(Direction::forward, 0, interior);
      if (!is_first) finish_exchange();
      sweep<N>(Direction::forward, interior, cells);
      if (!is_last) start_exchange();
    } else {
      if (!is_first) finish_exchange();
      sweep<N>(Direction::backward, interior, cells);
      if (!is_last) start_exchange();
      sweep<N>(Direction::backward, 0, interior);
    }
  }
  for (std::size_t k = 0; k < N; ++k)
    for (std::size_t cell = 0; cell < systems_[k]->right.size(); ++cell) {
      SweepState update = systems_[k]->update[static_cast<Index>(cell)];
      if (is_transposed_)
        multiply_add(0, matrix_.inverse_diagonal(static_cast<Index>(cell)), update.v)
            .copy_to(update.v, std::experimental::vector_aligned);
      for (int i = 0; i < 5; ++i) systems[k].update[cell][i] = update.v[i];
    }
}

void BlockLuSgs::solve(std::span<const LinearSystem> systems) {
  while (systems_.size() < std::min(systems.size(), most_together))
    systems_.push_back(std::make_unique<System>(discretization_.domain(), comm_));
  for (std::size_t begin = 0; begin < systems.size(); begin += most_together) {
    const auto group = systems.subspan(begin, std::min(most_together, systems.size() - begin));
    if (group.size() == 1) solve_together<1>(group);
    if (group.size() == 2) solve_together<2>(group);
    if (group.size() == 3) solve_together<3>(group);
    if (group.size() == 4) solve_together<4>(group);
  }
}

std::size_t BlockLuSgs::bytes() const {
  std::size_t out = matrix_.bytes();
  for (const auto& system : systems_)
    out += system->right.size() * sizeof(SweepState) + system->update.bytes();
  return out;
}

HaloTraffic BlockLuSgs::halo_traffic() const {
  HaloTraffic out;
  for (const auto& system : systems_) out = out + system->update.halo().traffic();
  return out;
}

}  // namespace alphadot
