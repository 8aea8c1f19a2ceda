#include "march/implicit_iteration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "march/update.hpp"

namespace alphadot {

ImplicitIteration::ImplicitIteration(const Discretization& discretization, const Communicator& comm,
                                     std::unique_ptr<LinearSolver> solver, const Vec3& moment_center)
    : discretization_(discretization),
      comm_(comm),
      solver_(std::move(solver)),
      moment_center_(moment_center),
      flow_(discretization.domain(), comm),
      residual_(discretization, comm),
      values_(static_cast<std::size_t>(discretization.domain().owned_cells)),
      update_(values_.size()) {}

void ImplicitIteration::set_uniform(const Primitive<Real>& state) {
  std::ranges::fill(flow_.values(), state);
}

void ImplicitIteration::evaluate(const Conditions<Real>& conditions, int order) {
  residual_.evaluate(flow_, conditions, order, values_);
}

void ImplicitIteration::sum(std::vector<Real>& numbers) const {
  const std::size_t own = numbers.size();
  const auto others = reduction_.of_this_rank();
  numbers.insert(numbers.end(), others.begin(), others.end());
  comm_.sum(numbers);
  reduction_.hear(std::span(numbers).subspan(own));
  numbers.resize(own);
}

FlowReport ImplicitIteration::report() const {
  Real square = 0, not_finite = 0;
  for (const auto& value : values_) {
    square += value[0] * value[0];
    not_finite += std::isfinite(value[0] + value[1] + value[2] + value[3] + value[4]) ? 0 : 1;
  }
  auto numbers = numbers_of(wall_loads(discretization_, residual_, moment_center_));
  const std::size_t of_loads = numbers.size();
  numbers.insert(numbers.end(),
                 {square, not_finite, static_cast<Real>(residual_.reconstruction().positivity_cells()),
                  static_cast<Real>(residual_.positivity_faces())});
  sum(numbers);
  FlowReport out;
  out.loads = loads_of(std::span(numbers).first(of_loads));
  out.total = total_of(out.loads);
  square = numbers[of_loads];
  not_finite = numbers[of_loads + 1];
  out.density_residual = std::sqrt(square / static_cast<Real>(discretization_.domain().global_cells));
  out.physical = not_finite == 0 && std::isfinite(square);
  out.positivity_cells = static_cast<GlobalIndex>(numbers[of_loads + 2]);
  out.positivity_faces = static_cast<GlobalIndex>(numbers[of_loads + 3]);
  return out;
}

std::vector<SuspectCell> ImplicitIteration::worst_cells(std::size_t count) const {
  constexpr Real not_finite = 1e300;
  const Subdomain& domain = discretization_.domain();
  const auto is_worse = [](const SuspectCell& a, const SuspectCell& b) { return a.change > b.change; };
  const auto keep_worst = [&](std::vector<SuspectCell>& cells) {
    const auto kept = static_cast<std::ptrdiff_t>(std::min(count, cells.size()));
    std::partial_sort(cells.begin(), cells.begin() + kept, cells.end(), is_worse);
    cells.resize(static_cast<std::size_t>(kept));
  };
  std::vector<SuspectCell> cells;
  for (Index cell = 0; cell < domain.owned_cells; ++cell) {
    const auto& value = values_[static_cast<std::size_t>(cell)];
    const bool finite = std::isfinite(value[0] + value[1] + value[2] + value[3] + value[4]);
    cells.push_back({domain.cell_ids[cell], domain.center[cell],
                     finite ? std::abs(value[0]) / domain.volume[cell] : not_finite});
  }
  keep_worst(cells);
  // Every rank puts its own into its place of one buffer.
  constexpr std::size_t numbers = 5;
  std::vector<Real> all(static_cast<std::size_t>(comm_.size()) * count * numbers);
  auto next =
      all.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(comm_.rank()) * count * numbers);
  for (const auto& cell : cells)
    for (const Real value :
         {static_cast<Real>(cell.id + 1), cell.center.x, cell.center.y, cell.center.z, cell.change})
      *next++ = value;
  comm_.sum(all);
  cells.clear();
  for (std::size_t i = 0; i < all.size(); i += numbers)
    if (all[i] > 0)
      cells.push_back(
          {static_cast<GlobalIndex>(all[i]) - 1, {all[i + 1], all[i + 2], all[i + 3]}, all[i + 4]});
  keep_worst(cells);
  return cells;
}

Index ImplicitIteration::advance() {
  ++iterations_;
  const LinearSystem system{values_, update_};
  stepper().solve({&system, 1});
  Index capped = 0;
  for (Index cell = 0; cell < discretization_.domain().owned_cells; ++cell) {
    const Primitive<Real> before = flow_[cell];
    const Real share = capped_share(before, update_[cell]);
    if (share < 1) ++capped;
    flow_[cell] += share * update_[cell];
    update_[cell] = before;
  }
  return capped;
}

void ImplicitIteration::use_krylov(int directions) {
  krylov_.reset();
  if (directions > 0)
    krylov_ = std::make_unique<Gmres>(discretization_, comm_, residual_, *solver_, directions);
}

void ImplicitIteration::shorten(Real share) {
  for (Index cell = 0; cell < discretization_.domain().owned_cells; ++cell)
    flow_[cell] = update_[cell] + share * (flow_[cell] - update_[cell]);
}

void ImplicitIteration::undo() {
  std::copy(update_.begin(), update_.end(), flow_.values().begin());
}

std::size_t ImplicitIteration::bytes() const {
  return discretization_.domain().bytes() + discretization_.bytes() + flow_.bytes() + residual_.bytes() +
         solver_->bytes() + (krylov_ ? krylov_->bytes() : 0) + values_.size() * sizeof(values_[0]) +
         update_.size() * sizeof(update_[0]);
}

}  // namespace alphadot
