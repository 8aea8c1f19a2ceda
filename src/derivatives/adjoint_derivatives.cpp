#include "derivatives/adjoint_derivatives.hpp"
#include "derivatives/flow_symmetry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "core/error.hpp"
#include "core/log.hpp"
#include "derivatives/block_solve.hpp"
#include "derivatives/controls.hpp"

namespace alphadot {

namespace {

/// What has to be solved for, by the length of the chain: adjoints to rates rest on those before them.
std::vector<std::vector<Functional>> chains_of(const std::vector<Functional>& functionals) {
  std::vector<std::vector<Functional>> out;
  for (const int rates : {0, 1, 2}) {
    auto& links = out.emplace_back();
    for (const auto& functional : functionals) {
      const Functional link{functional.coefficient, functional.patches, rates};
      if (functional.rates >= rates &&
          std::ranges::find(links, link.name(), &Functional::name) == links.end())
        links.push_back(link);
    }
  }
  return out;
}

}  // namespace

std::vector<Functional> all_functionals(const FlightCondition& settings) {
  std::vector<Functional> out;
  for (int coefficient = 0; coefficient < Coefficients::size(); ++coefficient)
    if (!vanishes(coefficient, settings)) out.push_back({coefficient});
  return out;
}

void check_has_transpose(const Case& settings) {
  if (settings.steady.scheme == SchemeKind::lu_sgs)
    throw InputError(settings.file, 0, "the adjoint needs an implicit scheme that has a transpose",
                     "set steady.scheme = \"block_lu_sgs\"");
}

AdjointDerivatives::AdjointDerivatives(FlowCase& flow, std::vector<Functional> functionals,
                                       SolveObserver observer)
    : flow_(flow),
      functionals_(std::move(functionals)),
      observer_(std::move(observer)),
      stream_([&] {
        check_has_transpose(flow.settings());
        std::vector<StreamChange> out;
        for (const auto& number : stream_numbers) out.emplace_back(flow.iteration(), flow.settings(), number);
        return out;
      }()),
      controls_(controls_of(flow.settings())),
      solver_(flow.iteration(), flow.conditions(), flow.settings().derivatives, observer_.go_on) {
  for (const auto& change : stream_) solver_.follow(change.residual());
  for (const Variable control : controls_) {
    const auto change = change_by_control(flow, control, false);
    solver_.follow(change.residual);
    auto loads = numbers_of(change.loads);
    flow_.communicator().sum(loads);
    control_loads_.push_back(loads_of(loads));
  }
}

bool AdjointDerivatives::solve(Adjoints& adjoints) {
  for (const auto& links : chains_of(functionals_)) {
    std::vector<AdjointProblem> problems;
    for (const auto& link : links) {
      if (adjoints.contains(link.name())) continue;
      if (link.rates == 0)
        problems.push_back({link.name(),
                            weights_of(link, flow_.setup().domain.patch_names, flow_.settings()),
                            {},
                            steady_error(flow_.steady_orders())});
      else
        problems.push_back({link.name(),
                            {},
                            adjoints.at(link.before().name()).field,
                            adjoints.at(link.before().name()).relative_error});
    }
    for (std::size_t begin = 0; begin < problems.size(); begin += problems_at_a_time) {
      const auto end = std::min(begin + problems_at_a_time, problems.size());
      auto solved = solver_.solve({problems.begin() + static_cast<std::ptrdiff_t>(begin),
                                   problems.begin() + static_cast<std::ptrdiff_t>(end)});
      if (solved.empty()) return false;
      for (auto& adjoint : solved) {
        spdlog::info("{:12} {:3} iterations, linear residual {:.1e}", adjoint.name, adjoint.iterations,
                     adjoint.relative_residual);
        adjoints[adjoint.name] = std::move(adjoint);
      }
      if (observer_.solved) observer_.solved();
    }
  }
  return true;
}

std::vector<std::string> AdjointDerivatives::unconverged(const Adjoints& adjoints,
                                                         std::vector<std::string>& shortfalls) const {
  const bool is_deep = flow_.steady_orders() >= deep_steady_orders;
  if (!is_deep)
    shortfalls.push_back(fmt::format("adjoints are about a flow {:.1f} decades down, and need {:g}",
                                     flow_.steady_orders(), deep_steady_orders));
  std::vector<std::string> out;
  const auto is_in = [&](const std::string& name) { return std::ranges::find(out, name) != out.end(); };
  for (const auto& links : chains_of(functionals_))
    for (const auto& link : links) {
      const Adjoint& adjoint = adjoints.at(link.name());
      const bool rests_on_it = link.rates > 0 && is_in(link.before().name());
      auto shortfall = shortfall_of_solve("the adjoint of " + link.name(), adjoint.relative_residual,
                                          adjoint.iterations, flow_.settings().derivatives.orders);
      if (!shortfall.empty() || !is_deep || rests_on_it) out.push_back(link.name());
      if (!shortfall.empty()) shortfalls.push_back(std::move(shortfall));
    }
  return out;
}

/// The load's own part and what the flow does.
Estimate AdjointDerivatives::by_control(const Functional& functional, const Adjoint& adjoint,
                                        Variable control) const {
  const auto at = static_cast<std::size_t>(std::ranges::find(controls_, control) - controls_.begin());
  const auto weights = weights_of(functional, flow_.setup().domain.patch_names, flow_.settings());
  Estimate out{adjoint.products[stream_.size() + at], adjoint.products_error[stream_.size() + at]};
  for (std::size_t patch = 0; patch < weights.size(); ++patch)
    out.value += dot(weights[patch].force, control_loads_[at][patch].force) +
                 dot(weights[patch].moment, control_loads_[at][patch].moment);
  return out;
}

std::vector<TableRow> AdjointDerivatives::rows(const Adjoints& adjoints,
                                               std::vector<std::string>& shortfalls) const {
  const Case& settings = flow_.settings();
  const auto fell_short = unconverged(adjoints, shortfalls);
  std::vector<TableRow> rows;
  for (const auto& functional : functionals_) {
    const Adjoint& adjoint = adjoints.at(functional.name());
    const std::size_t first = rows.size();
    const Part part =
        functional.patches.empty() ? Part() : Part(functional.patches, flow_.setup().domain.patch_names);
    const auto symmetry = symmetry_of(part, flow_, settings);
    for (const Variable variable : variables_of(functional, settings)) {
      Estimate found = derivative(adjoint, variable, settings);
      if (symmetry.makes_zero(functional.coefficient, variable)) found.uncertainty += std::abs(found.value);
      rows.push_back({derivative_name(functional, name(variable)), found, "adjoint, k -> 0"});
    }
    for (std::size_t i = 0; functional.rates == 0 && i < stream_.size(); ++i)
      rows.push_back(
          {derivative_name(functional, stream_[i].name()),
           {stream_[i].by_itself(functional, flow_.setup().domain.patch_names) + adjoint.products[i],
            adjoint.products_error[i]},
           "adjoint, incidence and reduced rates held"});
    auto controls = controls_;
    const auto sets = control_sets_of(settings);
    controls.insert(controls.end(), sets.begin(), sets.end());
    for (std::size_t i = 0; functional.rates == 0 && i < controls.size(); ++i) {
      Estimate sum;
      for (const auto& [control, weight] : terms_of(controls[i], settings))
        sum += weight * by_control(functional, adjoint, control);
      rows.push_back({derivative_name(functional, name(controls[i])), sum, "adjoint, k -> 0"});
    }
    for (std::size_t i = first; i < rows.size(); ++i)
      rows[i].converged = std::ranges::find(fell_short, functional.name()) == fell_short.end();
  }
  return rows;
}

SurfaceSensitivity AdjointDerivatives::by_shape(const Functional& functional, const Adjoints& adjoints) {
  const auto weights = weights_of(functional, flow_.setup().domain.patch_names, flow_.settings());
  return {flow_.discretization(), flow_.communicator(),
          solver_.by_points(adjoints.at(functional.name()), weights)};
}

}  // namespace alphadot
