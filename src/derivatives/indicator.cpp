#include "derivatives/indicator.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "derivatives/mass_term.hpp"
#include "linear/tangent_transpose.hpp"
#include "space/dissipation.hpp"

namespace alphadot {

namespace {

using Field = std::vector<Five<Real>>;

/// Of central differences: the root mean square over the cells of the change of density, pressure or
/// velocity, beside their own size and the speed of sound; and the largest change at most. Roe's dissipation
/// has kinks where a face lies along the stream. A step that takes many faces across theirs smooths them; a
/// tiny one takes few, each with its inverse.
constexpr Real usual_step = 3e-3, largest_step = 0.1;

/// A response that the flow is moved along, and the change of the conditions that goes with it.
struct Direction {
  std::span<const Primitive<Real>> response;
  ConditionsChange change;
};

Real step_along(const ImplicitIteration& iteration, const Direction& direction) {
  const Real gamma = iteration.discretization().gamma();
  Real largest = 1e-300, squares = 1e-300;
  for (std::size_t cell = 0; cell < direction.response.size(); ++cell) {
    const auto& w = iteration.flow()[static_cast<Index>(cell)];
    const auto& change = direction.response[cell];
    const Real relative = std::max({std::abs(change[0] / w[0]), std::abs(change[4] / w[4]),
                                    norm(velocity(change)) / sound_speed(w, gamma)});
    largest = std::max(largest, relative);
    squares += relative * relative;
  }
  const auto& comm = iteration.communicator();
  const auto cells = static_cast<Real>(iteration.discretization().domain().global_cells);
  return std::min(usual_step / std::sqrt(comm.sum(squares) / cells), largest_step / comm.max(largest));
}

Conditions<Real> moved(Conditions<Real> conditions, Real step, const ConditionsChange& change) {
  for (int axis = 0; axis < 3; ++axis) conditions.free_stream[1 + axis] += step * change.wind[axis];
  conditions.turning_stream += step * change.wind;
  conditions.grid.velocity += step * change.grid_velocity;
  conditions.grid.rotation += step * change.rotation;
  return conditions;
}

/// The flow moved along a direction, with what is needed there.
class MovedFlow {
 public:
  MovedFlow(const ImplicitIteration& iteration, const Conditions<Real>& conditions,
            const Direction& direction, Real step)
      : iteration_(iteration),
        discretization_(iteration.discretization()),
        conditions_(moved(conditions, step, direction.change)),
        flow_(discretization_.domain(), iteration.communicator()),
        reconstruction_(discretization_, iteration.communicator()) {
    for (Index cell = 0; cell < discretization_.domain().owned_cells; ++cell)
      flow_[cell] = iteration.flow()[cell] + step * direction.response[static_cast<std::size_t>(cell)];
    reconstruction_.update(flow_, discretization_.space().order);
  }

  Field dissipation() const {
    return alphadot::dissipation(discretization_, flow_, reconstruction_, conditions_);
  }
  /// sum += factor (A^T y - J_W^T), J of these weights or none.
  void add_transposed(Real factor, std::span<const Conserved<Real>> y, std::span<const Load> weights,
                      Field& sum) {
    if (!linearisation_)
      linearisation_.emplace(discretization_, iteration_.communicator(), flow_, reconstruction_, conditions_);
    TangentTranspose<1> transpose(*linearisation_, iteration_.moment_center());
    std::vector<Load> minus;
    for (const Load& weight : weights) minus.push_back(-1 * weight);
    image_.resize(sum.size());
    transpose.apply({y}, {minus}, {image_});
    for (std::size_t cell = 0; cell < sum.size(); ++cell) sum[cell] += factor * image_[cell];
  }
  /// sum += factor M^T y
  void add_transposed_mass(Real factor, std::span<const Conserved<Real>> y, Field& sum) const {
    for (std::size_t cell = 0; cell < sum.size(); ++cell)
      sum[cell] +=
          factor * discretization_.domain().volume[cell] *
          conserved_change_transposed(flow_[static_cast<Index>(cell)], y[cell], discretization_.gamma());
  }

 private:
  const ImplicitIteration& iteration_;
  const Discretization& discretization_;
  Conditions<Real> conditions_;
  FlowField<Real> flow_;
  Reconstruction<Real> reconstruction_;
  std::optional<Linearisation> linearisation_;
  Field image_;
};

/// Adds half of |dissipation . (difference of the adjoint)| on every face to the cells on its sides.
void add_weighted(const ImplicitIteration& iteration, std::span<const Conserved<Real>> dissipation,
                  std::span<const Conserved<Real>> adjoint, std::span<Real> of_cells) {
  const Subdomain& domain = iteration.discretization().domain();
  CellField<Conserved<Real>> y(domain, iteration.communicator(), HaloWidth::faces);
  std::ranges::copy(adjoint, y.values().begin());
  y.exchange();
  for (std::size_t face = 0; face < domain.faces.size(); ++face) {
    const auto [left, right] = domain.faces[face];
    Real product = 0;
    for (int i = 0; i < 5; ++i) product += (y[left][i] - y[right][i]) * dissipation[face][i];
    of_cells[static_cast<std::size_t>(left)] += 0.5 * std::abs(product);
    if (right < domain.owned_cells) of_cells[static_cast<std::size_t>(right)] += 0.5 * std::abs(product);
  }
}

/// Each response once, whatever the number of chains that have it.
std::vector<Direction> directions_of(std::span<const DerivativeChain> chains) {
  std::vector<Direction> out;
  for (const auto& chain : chains)
    for (std::size_t j = 0; j < chain.responses.size(); ++j)
      if (std::ranges::none_of(out, [&](const Direction& known) {
            return known.response.data() == chain.responses[j].data();
          }))
        out.push_back({chain.responses[j], j == 0 ? chain.change : ConditionsChange{}});
  return out;
}

/// The number of a response in a chain, if it is one of it.
std::optional<std::size_t> place_in(const DerivativeChain& chain, const Direction& direction) {
  for (std::size_t j = 0; j < chain.responses.size(); ++j)
    if (chain.responses[j].data() == direction.response.data()) return j;
  return std::nullopt;
}

}  // namespace

std::vector<Indicator> indicators(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                                  AdjointSolver& solver, std::span<const DerivativeChain> chains) {
  const auto cells = static_cast<std::size_t>(iteration.discretization().domain().owned_cells);
  std::vector<Indicator> out;
  for (const auto& chain : chains) {
    auto& one = out.emplace_back();
    one.name = chain.name;
    one.of_cells.resize(cells);
  }
  std::vector<Field> sources(chains.size(), Field(cells));

  for (const auto& direction : directions_of(chains)) {
    const Real step = step_along(iteration, direction);
    Field change(iteration.discretization().domain().faces.size());
    for (const Real side : {1, -1}) {
      MovedFlow there(iteration, conditions, direction, side * step);
      const Real factor = side / (2 * step);
      const Field dissipation = there.dissipation();
      for (std::size_t face = 0; face < change.size(); ++face) change[face] += factor * dissipation[face];
      for (std::size_t i = 0; i < chains.size(); ++i) {
        const auto& chain = chains[i];
        const auto j = place_in(chain, direction);
        if (!j) continue;
        const std::size_t k = chain.adjoints.size() - 1 - *j;  // the adjoint of the equation of U_j
        there.add_transposed(factor, chain.adjoints[k], k == 0 ? chain.weights : std::span<const Load>{},
                             sources[i]);
        if (k > 0) there.add_transposed_mass(factor, chain.adjoints[k - 1], sources[i]);
      }
    }
    for (std::size_t i = 0; i < chains.size(); ++i)
      if (const auto j = place_in(chains[i], direction))
        add_weighted(iteration, change, chains[i].adjoints[chains[i].adjoints.size() - 1 - *j],
                     out[i].of_cells);
  }

  std::vector<AdjointProblem> problems;
  for (std::size_t i = 0; i < chains.size(); ++i)
    problems.push_back({.name = chains[i].name + " to the steady flow", .source = sources[i]});
  const Field steady = MovedFlow(iteration, conditions, {Field(cells), {}}, 0).dissipation();
  auto solved = solver.solve(problems);
  if (solved.size() < problems.size()) return {};
  for (std::size_t i = 0; i < chains.size(); ++i) {
    out[i].relative_residual = solved[i].relative_residual;
    out[i].iterations = solved[i].iterations;
    out[i].steady_adjoint = std::move(solved[i].field);
    add_weighted(iteration, steady, out[i].steady_adjoint, out[i].of_cells);
  }
  return out;
}

std::vector<Real> joined(std::span<const Indicator> indicators, const Communicator& comm) {
  std::vector<Real> out;
  for (const auto& indicator : indicators) {
    const auto& of_cells = indicator.of_cells;
    out.resize(of_cells.size());
    const Real sum = comm.sum(std::accumulate(of_cells.begin(), of_cells.end(), Real{0}));
    const Real factor = sum > 0 ? 1 / (sum * static_cast<Real>(indicators.size())) : 0;
    for (std::size_t cell = 0; cell < out.size(); ++cell) out[cell] += factor * of_cells[cell];
  }
  return out;
}

}  // namespace alphadot
