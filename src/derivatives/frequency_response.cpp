#include "derivatives/frequency_response.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <utility>

#include "derivatives/block_solve.hpp"
#include "derivatives/loads.hpp"
#include "derivatives/mass_term.hpp"
#include "derivatives/remaining_error.hpp"
#include "linear/cell_scaling.hpp"

namespace alphadot {

namespace {

/// A + i omega M with the problems' sources, as a block solve wants it. Both parts of all fields pass through
/// one tangent.
template <int N>
class FrequencyOperator {
 public:
  static constexpr std::size_t parts = 2;
  static constexpr auto transposed = Transposed::no;

  FrequencyOperator(ImplicitIteration& iteration, const Linearisation& linearisation, Real omega,
                    std::array<OscillatingSource, N> sources)
      : iteration_(iteration),
        omega_(omega),
        sources_(std::move(sources)),
        scaling_(iteration.discretization(), iteration.flow(), linearisation.conditions()),
        tangent_(linearisation, iteration.moment_center()),
        cells_(static_cast<std::size_t>(iteration.discretization().domain().owned_cells)) {
    // A disturbance that the stream carries has this phase, and the scheme to work on what is left of it.
    const Vec3 stream = velocity(linearisation.conditions().free_stream);
    const auto& center = iteration.discretization().domain().center;
    for (std::size_t cell = 0; cell < cells_; ++cell)
      phase_.push_back(std::polar(Real{1}, omega * dot(center[cell], stream) / dot(stream, stream)));
  }

  void apply(const std::array<std::span<const Primitive<Real>>, N>& fields,
             const std::array<std::span<Conserved<Real>>, N>& images, bool with_source) {
    typename Tangent<2 * N>::Fields halves;
    typename Tangent<2 * N>::Images half_images;
    for (std::size_t k = 0; k < N; ++k) {
      halves[2 * k] = fields[k].first(cells_);
      halves[2 * k + 1] = fields[k].last(cells_);
      half_images[2 * k] = images[k].first(cells_);
      half_images[2 * k + 1] = images[k].last(cells_);
    }
    tangent_.apply(halves, {}, half_images);
    loads_ = tangent_.loads();
    for (std::size_t k = 0; k < N; ++k) {
      add_mass_term(iteration_, -omega_, halves[2 * k + 1], half_images[2 * k]);
      add_mass_term(iteration_, omega_, halves[2 * k], half_images[2 * k + 1]);
      if (!with_source) continue;
      for (std::size_t cell = 0; cell < 2 * cells_; ++cell) images[k][cell] += sources_[k].residual[cell];
      for (std::size_t part = 0; part < 2; ++part)
        for (std::size_t patch = 0; patch < loads_[2 * k + part].size(); ++patch)
          loads_[2 * k + part][patch] += sources_[k].loads[part][patch];
    }
  }
  std::vector<Real> functionals(std::size_t k) const {
    auto out = numbers_of(loads_[2 * k]);
    const auto imaginary = numbers_of(loads_[2 * k + 1]);
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
  void turn(std::span<Five<Real>> field, int sign) const {
    for (std::size_t cell = 0; cell < cells_; ++cell) {
      const Real cosine = phase_[cell].real(), sine = sign * phase_[cell].imag();
      const auto real = field[cell], imaginary = field[cells_ + cell];
      field[cell] = cosine * real - sine * imaginary;
      field[cells_ + cell] = cosine * imaginary + sine * real;
    }
  }

 private:
  ImplicitIteration& iteration_;
  Real omega_;
  std::array<OscillatingSource, N> sources_;
  CellScaling scaling_;
  Tangent<2 * N> tangent_;
  std::size_t cells_;
  std::vector<std::complex<Real>> phase_;  // [owned_cells]
  std::array<std::vector<Load>, 2 * N> loads_;
};

/// [owned_cells] of D M: D is (dW/dU) over the wave speeds, M is V dU/dW.
std::vector<Real> crossing_times(const ImplicitIteration& iteration, const Conditions<Real>& conditions) {
  auto out = wave_speeds(iteration.discretization(), iteration.flow(), conditions);
  for (std::size_t cell = 0; cell < out.size(); ++cell)
    out[cell] = iteration.discretization().domain().volume[cell] / out[cell];
  return out;
}

/// How far the norms of projections have gone down, and on how many of the way, for the last one's error to
/// be judged by them.
bool is_sampled(std::span<const ReducedModel::Projection> projections) {
  constexpr std::size_t fewest = 4;
  constexpr Real decade = 10;
  return projections.size() >= fewest && projections.front().norm >= decade * projections.back().norm;
}

FrequencyResponse response_of(Real orders, Real inherited_error, Real imaginary_weight,
                              std::vector<Primitive<Real>> field, BlockRecord record,
                              std::span<const ReducedModel::Projection> before, int iterations,
                              Real body_size, const Communicator& comm) {
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
  // So are what other frequencies tell, and less of it.
  for (const auto& projection : before) {
    auto loads = loads_of(projection.functionals);
    const auto totals = {total_of(std::span(loads).first(static_cast<std::size_t>(patches))),
                         total_of(std::span(loads).last(static_cast<std::size_t>(patches)))};
    loads.insert(loads.end(), totals);
    record.norms.insert(record.norms.begin(), projection.norm);
    record.functionals.insert(record.functionals.begin(), numbers_of(loads));
  }
  out.relative_residual = record.drop();
  out.iterations = iterations;
  // The field of zeros, whose residual is the source, is one more sample.
  record.norms.insert(record.norms.begin(), record.reference_norm);
  record.functionals.insert(record.functionals.begin(),
                            std::vector<Real>(record.functionals.front().size(), 0));
  // Of the size of both parts each is taken to be.
  Load size;
  for (int axis = 0; axis < 3; ++axis) {
    size.force[axis] = std::hypot(out.total[0].force[axis], out.total[1].force[axis]);
    size.moment[axis] = std::hypot(out.total[0].moment[axis], out.total[1].moment[axis]);
  }
  auto scales = scales_of(size, body_size, static_cast<std::size_t>(2 * patches + 2));
  // An imaginary part of the residual that counts so many times does so much less.
  const std::size_t numbers = scales.size() / static_cast<std::size_t>(2 * patches + 2);
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const auto load = static_cast<std::ptrdiff_t>(i / numbers);
    if ((load >= patches && load < 2 * patches) || load == 2 * patches + 1) scales[i] /= imaginary_weight;
  }
  auto remaining = loads_of(remaining_error(record.norms, record.functionals, scales, out.relative_residual,
                                            orders, bends + inherited_error));
  // What is left turns: of a load's parts either may be off by what both are.
  const auto turn_one = [&](Real& real, Real& imaginary) {
    const Real first = real, second = imaginary;
    real = std::hypot(first, second);
    imaginary = std::hypot(first / imaginary_weight, second);
  };
  const auto turn = [&](Load& real, Load& imaginary) {
    for (int axis = 0; axis < 3; ++axis) {
      turn_one(real.force[axis], imaginary.force[axis]);
      turn_one(real.moment[axis], imaginary.moment[axis]);
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
                                 const DerivativeSettings& settings, std::vector<Oscillation> oscillations,
                                 Real inherited_error, std::function<bool()> go_on)
    : basis_(iteration, conditions, settings, std::move(go_on)),
      oscillations_(std::move(oscillations)),
      inherited_error_(inherited_error),
      model_(crossing_times(iteration, basis_.linearisation.conditions()),
             [&iteration](std::vector<Real>& numbers) { iteration.sum(numbers); }) {
  if (oscillations_.empty() || oscillations_.size() > most_oscillations)
    throw std::logic_error("one or two oscillations are solved for together");
  basis_.settings.method = SensitivityMethod::gmres;
}

OscillatingSource FrequencySolver::source_of(const Oscillation& oscillation, Real omega) {
  ImplicitIteration& iteration = basis_.iteration;
  if (norm(oscillation.gust) > 0)
    return gust_wave(basis_.linearisation, oscillation.gust, omega, iteration.moment_center());
  const auto cells = static_cast<std::size_t>(iteration.discretization().domain().owned_cells);
  const std::vector<Primitive<Real>> zero(cells);
  OscillatingSource out{std::vector<Conserved<Real>>(2 * cells), {}};
  Tangent<1> tangent(basis_.linearisation, iteration.moment_center());
  tangent.apply({zero}, {oscillation.change}, {std::span(out.residual).first(cells)});
  out.loads[0] = tangent.loads()[0];
  out.loads[1].resize(out.loads[0].size());
  return out;
}

std::size_t FrequencySolver::add_source(const OscillatingSource& source) {
  ImplicitIteration& iteration = basis_.iteration;
  const std::size_t cells = source.residual.size() / 2;
  const CellScaling scaling(iteration.discretization(), iteration.flow(), basis_.linearisation.conditions());
  ReducedModel::Source known{std::vector<Primitive<Real>>(2 * cells), numbers_of(source.loads[0])};
  const auto imaginary = numbers_of(source.loads[1]);
  known.functionals.insert(known.functionals.end(), imaginary.begin(), imaginary.end());
  iteration.sum(known.functionals);
  const std::span scaled(known.scaled);
  scaling.scale(std::span(source.residual).first(cells), scaled.first(cells));
  scaling.scale(std::span(source.residual).last(cells), scaled.last(cells));
  std::vector<Real> squares{square(known.scaled)};
  iteration.sum(squares);
  source_norms_.push_back(std::sqrt(squares[0]));
  return model_.add_source(std::move(known));
}

void FrequencySolver::know(std::span<const Primitive<Real>> response) {
  const std::size_t cells = response.size() / 2;
  ImplicitIteration& iteration = basis_.iteration;
  const CellScaling scaling(iteration.discretization(), iteration.flow(), basis_.linearisation.conditions());
  Tangent<2> tangent(basis_.linearisation, iteration.moment_center());
  std::array<std::vector<Primitive<Real>>, 2> images;
  for (auto& image : images) image.resize(cells);
  tangent.apply({response.first(cells), response.last(cells)}, {}, {images[0], images[1]});
  const auto loads = tangent.loads();
  for (std::size_t part = 0; part < 2; ++part) {
    auto functionals = numbers_of(loads[part]);
    iteration.sum(functionals);
    scaling.scale(images[part], images[part]);
    const auto field = response.subspan(part * cells, cells);
    model_.add_field({field.begin(), field.end()}, std::move(images[part]), std::move(functionals));
  }
}

std::vector<FrequencySolver::Projections> FrequencySolver::known_at(const Asked& asked) const {
  std::vector<Projections> out;
  for (const std::size_t source : asked.sources)
    out.push_back(model_.project(source, asked.frequency.omega, asked.frequency.imaginary_weight));
  return out;
}

Real FrequencySolver::left_by(const Asked& asked) const {
  const auto known = known_at(asked);
  Real out = 0;
  for (std::size_t k = 0; k < known.size(); ++k)
    if (const Real whole = source_norms_[asked.sources[k]]; whole > 0)
      out = std::max(out, known[k].empty() ? 1 : known[k].back().norm / whole);
  return out;
}

bool FrequencySolver::solve(std::span<const Frequency> frequencies, const Take& take) {
  std::vector<Asked> all;
  for (const Frequency& frequency : frequencies) all.push_back({frequency, {}});
  for (const auto& oscillation : oscillations_) {
    const bool is_wave = norm(oscillation.gust) > 0;  // another source at each frequency
    for (Asked& asked : all)
      asked.sources.push_back(is_wave || &asked == all.data()
                                  ? add_source(source_of(oscillation, asked.frequency.omega))
                                  : all.front().sources.back());
  }
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < all.size(); ++i) open.push_back(i);
  std::ranges::stable_sort(open, std::greater{}, [&](std::size_t i) { return frequencies[i].omega; });
  while (!open.empty()) {
    const auto next = std::ranges::max_element(open, {}, [&](std::size_t i) { return left_by(all[i]); });
    const std::size_t number = *next;
    open.erase(next);
    std::vector<FrequencyResponse> responses;
    const bool is_done =
        oscillations_.size() == 1 ? solve_at<1>(all[number], responses) : solve_at<2>(all[number], responses);
    if (!is_done) return false;
    if (!open.empty() && responses.front().iterations > 0)
      for (const auto& response : responses) know(response.field);
    take(number, std::move(responses));
  }
  return true;
}

template <int N>
bool FrequencySolver::solve_at(const Asked& asked, std::vector<FrequencyResponse>& out) {
  const auto& [omega, imaginary_weight] = asked.frequency;
  const auto known = known_at(asked);
  std::array<std::vector<Primitive<Real>>, N> guesses;
  std::array<BlockProblem, N> problems;
  std::array<OscillatingSource, N> sources;
  for (std::size_t k = 0; k < N; ++k) {
    if (!known[k].empty()) guesses[k] = model_.field(known[k].back());
    problems[k] = {oscillations_[k].name,           basis_.settings.orders, guesses[k],
                   source_norms_[asked.sources[k]], imaginary_weight,       is_sampled(known[k])};
    sources[k] = source_of(oscillations_[k], omega);
  }
  FrequencyOperator<N> shifted(basis_.iteration, basis_.linearisation, omega, std::move(sources));
  BlockSolve<N, FrequencyOperator<N>> way(shifted, basis_.iteration, basis_.linearisation.conditions(),
                                          problems, basis_.settings, basis_.go_on);
  if (!way.solve()) return false;
  for (std::size_t k = 0; k < N; ++k)
    out.push_back(response_of(basis_.settings.orders, inherited_error_, imaginary_weight,
                              std::move(way.field(k)), way.record(k), known[k], way.iterations(),
                              basis_.body_size, basis_.iteration.communicator()));
  return true;
}

}  // namespace alphadot
