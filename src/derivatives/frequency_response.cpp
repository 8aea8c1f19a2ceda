#include "derivatives/frequency_response.hpp"

#include <cmath>
#include <utility>

#include "derivatives/block_solve.hpp"
#include "derivatives/loads.hpp"
#include "derivatives/mass_term.hpp"
#include "derivatives/remaining_error.hpp"
#include "linear/cell_scaling.hpp"

namespace alphadot {

namespace {

/// A + i omega M with the problem's source, as a block solve wants it. Both parts of the field pass through
/// one tangent.
class FrequencyOperator {
 public:
  static constexpr std::size_t parts = 2;
  static constexpr auto transposed = Transposed::no;

  FrequencyOperator(ImplicitIteration& iteration, const Linearisation& linearisation,
                    const FrequencyProblem& problem)
      : iteration_(iteration),
        problem_(problem),
        scaling_(iteration.discretization(), iteration.flow(), linearisation.conditions()),
        tangent_(linearisation, iteration.moment_center()),
        cells_(static_cast<std::size_t>(iteration.discretization().domain().owned_cells)) {}

  void apply(const std::array<std::span<const Primitive<Real>>, 1>& fields,
             const std::array<std::span<Conserved<Real>>, 1>& images, bool with_source) {
    const auto real = fields[0].first(cells_), imaginary = fields[0].last(cells_);
    const auto real_image = images[0].first(cells_), imaginary_image = images[0].last(cells_);
    tangent_.apply({real, imaginary}, {with_source ? problem_.change : ConditionsChange{}, {}},
                   {real_image, imaginary_image});
    loads_ = tangent_.loads();
    add_mass_term(iteration_, -problem_.omega, imaginary, real_image);
    add_mass_term(iteration_, problem_.omega, real, imaginary_image);
  }
  std::vector<Real> functionals(std::size_t) const {
    auto out = numbers_of(loads_[0]);
    const auto imaginary = numbers_of(loads_[1]);
    out.insert(out.end(), imaginary.begin(), imaginary.end());
    return out;
  }
  void scale(std::span<const Conserved<Real>> image, std::span<Primitive<Real>> out) const {
    scaling_.scale(image.first(cells_), out.first(cells_));
    scaling_.scale(image.last(cells_), out.last(cells_));
  }
  void unscale(std::span<const Primitive<Real>> scaled, std::span<Conserved<Real>> out) const {
    scaling_.unscale(scaled.first(cells_), out.first(cells_));
    scaling_.unscale(scaled.last(cells_), out.last(cells_));
  }

  /// |D b|. Collective.
  Real source_norm() {
    std::vector<Five<Real>> zero(2 * cells_), image(2 * cells_);
    apply({zero}, {image}, true);
    scale(image, image);
    std::vector<Real> squares{square(image)};
    iteration_.sum(squares);
    return std::sqrt(squares[0]);
  }

 private:
  ImplicitIteration& iteration_;
  const FrequencyProblem& problem_;
  CellScaling scaling_;
  Tangent<2> tangent_;
  std::size_t cells_;
  std::array<std::vector<Load>, 2> loads_;
};

FrequencyResponse response_of(Real orders, Real inherited_error, std::vector<Primitive<Real>> field,
                              BlockRecord record, int iterations, Real body_size, const Communicator& comm) {
  FrequencyResponse out;
  out.field = std::move(field);
  std::ptrdiff_t patches = 0;
  for (auto& functionals : record.functionals) {
    comm.sum(functionals);
    auto loads = loads_of(functionals);
    patches = static_cast<std::ptrdiff_t>(loads.size() / 2);
    out.loads = {std::vector(loads.begin(), loads.begin() + patches),
                 std::vector(loads.begin() + patches, loads.end())};
    out.total = {total_of(out.loads[0]), total_of(out.loads[1])};
    loads.insert(loads.end(), out.total.begin(), out.total.end());
    functionals = numbers_of(loads);
  }
  out.relative_residual = record.drop();
  out.iterations = iterations;
  // The field of zeros, whose residual is the source, is one more sample: the only one from a good guess.
  record.norms.insert(record.norms.begin(), record.reference_norm);
  record.functionals.insert(record.functionals.begin(),
                            std::vector<Real>(record.functionals.front().size(), 0));
  // Of the size of both parts each is taken to be.
  Load size;
  for (int axis = 0; axis < 3; ++axis) {
    size.force[axis] = std::hypot(out.total[0].force[axis], out.total[1].force[axis]);
    size.moment[axis] = std::hypot(out.total[0].moment[axis], out.total[1].moment[axis]);
  }
  const auto scales = scales_of(size, body_size, static_cast<std::size_t>(2 * patches + 2));
  auto remaining = loads_of(remaining_error(record.norms, record.functionals, scales, out.relative_residual,
                                            orders, inherited_error));
  // What is left turns: of a load's parts either may be off by what both are.
  const auto turn = [](Load& real, Load& imaginary) {
    for (int axis = 0; axis < 3; ++axis) {
      real.force[axis] = imaginary.force[axis] = std::hypot(real.force[axis], imaginary.force[axis]);
      real.moment[axis] = imaginary.moment[axis] = std::hypot(real.moment[axis], imaginary.moment[axis]);
    }
  };
  for (std::ptrdiff_t patch = 0; patch < patches; ++patch)
    turn(*(remaining.begin() + patch), *(remaining.begin() + patches + patch));
  turn(remaining[remaining.size() - 2], remaining.back());
  out.loads_error = {std::vector(remaining.begin(), remaining.begin() + patches),
                     std::vector(remaining.begin() + patches, remaining.begin() + 2 * patches)};
  out.total_error = {remaining[remaining.size() - 2], remaining.back()};
  return out;
}

}  // namespace

FrequencySolver::FrequencySolver(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                                 const DerivativeSettings& settings, std::function<bool()> go_on)
    : basis_(iteration, conditions, settings, std::move(go_on)) {
  basis_.settings.method = SensitivityMethod::gmres;
}

bool FrequencySolver::solve(const FrequencyProblem& problem, FrequencyResponse& out) {
  FrequencyOperator shifted(basis_.iteration, basis_.linearisation, problem);
  BlockSolve<1, FrequencyOperator> way(
      shifted, basis_.iteration, basis_.linearisation.conditions(),
      {BlockProblem{problem.name, basis_.settings.orders, problem.guess, shifted.source_norm()}},
      basis_.settings, basis_.go_on);
  if (!way.solve()) return false;
  out = response_of(basis_.settings.orders, problem.inherited_error, std::move(way.field(0)), way.record(0),
                    way.iterations(), basis_.body_size, basis_.iteration.communicator());
  return true;
}

}  // namespace alphadot
