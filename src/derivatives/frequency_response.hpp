// Linear response of a steady flow to conditions that oscillate: the frequency domain.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "derivatives/derivative_basis.hpp"
#include "derivatives/gust_wave.hpp"
#include "derivatives/reduced_model.hpp"
#include "linear/tangent.hpp"
#include "march/implicit_iteration.hpp"

namespace alphadot {

/// What oscillates: c = c0 + change exp(i omega t); or, where it is not zero, a gust_wave() of this velocity.
struct Oscillation {
  std::string name;
  ConditionsChange change;
  Vec3 gust = {};
};

/// Responses to them, several at a time: of linear problems (A + i omega M) U = -(dR/dc) about a steady flow,
/// A = dR/dW and M = V dU/dW. With the semi-discrete equations V dU/dt + R(W, c) = 0, W = W0 + U exp(i omega
/// t). No time step and no amplitude enters. omega -> 0 gives the responses of sensitivity.hpp: the real part
/// that to the change, the imaginary one omega times that to its rate (K. C. Hall & E. F. Crawley, AIAA
/// Journal 27, 1989, 777).
struct FrequencyResponse {
  std::vector<Primitive<Real>> field;  ///< U, real part and then imaginary one, [2 owned_cells]
  std::array<std::vector<Load>, 2> loads, loads_error;  ///< of every patch, over all ranks
  std::array<Load, 2> total, total_error;               ///< real, imaginary; as those of a Sensitivity
  Real relative_residual = 1;  ///< |D (A U + i omega M U + b)| / |D b|, the imaginary part weighted
  int iterations = 0;
};

/// A frequency to solve for.
struct Frequency {
  Real omega;  ///< rad per unit of time
  /// That of a residual's imaginary part in its norm: a response is nearly all real where omega is small.
  Real imaginary_weight = 1;
};

/// Solves for them at many frequencies by GMRES over the complex numbers, preconditioned by the implicit
/// scheme for either part, on a phase that goes with the stream. Each solve begins from what the others tell;
/// next comes the frequency of which they tell least.
class FrequencySolver {
 public:
  static constexpr std::size_t most_oscillations = 2;

  /// The flow of `iteration` must be steady under `conditions`; what it is off may change responses by the
  /// share `inherited_error`. One or two oscillations, solved for together. Of `settings` all but the method
  /// count; `go_on`, when given, is asked after each linear iteration, on every rank. Collective.
  FrequencySolver(ImplicitIteration& iteration, const Conditions<Real>& conditions,
                  const DerivativeSettings& settings, std::vector<Oscillation> oscillations,
                  Real inherited_error = 0, std::function<bool()> go_on = {});

  /// Fields to look for solutions in, beside those of solve(): of a response at any frequency. Collective.
  void know(std::span<const Primitive<Real>> response);

  /// Gives the number of a frequency and the responses to all oscillations.
  using Take = std::function<void(std::size_t, std::vector<FrequencyResponse>)>;
  /// Solves for all frequencies, in an order of its own. False when `go_on` said no. Throws DivergedError
  /// when a solution leaves the numbers. Collective.
  bool solve(std::span<const Frequency> frequencies, const Take& take);

 private:
  using Projections = std::vector<ReducedModel::Projection>;  // of fewer fields first
  /// A frequency and the numbers of the sources there, of each oscillation.
  struct Asked {
    Frequency frequency;
    std::vector<std::size_t> sources;
  };

  /// [2 owned_cells] of the complex source, and its loads.
  OscillatingSource source_of(const Oscillation& oscillation, Real omega);
  std::size_t add_source(const OscillatingSource& source);
  /// What is known of the responses at a frequency, of each oscillation.
  std::vector<Projections> known_at(const Asked& asked) const;
  /// The largest share of the source that they leave.
  Real left_by(const Asked& asked) const;
  template <int N>
  bool solve_at(const Asked& asked, std::vector<FrequencyResponse>& out);

  DerivativeBasis basis_;
  std::vector<Oscillation> oscillations_;
  Real inherited_error_;
  std::vector<Real> source_norms_;  // |D b| by the number of the source
  ReducedModel model_;
};

}  // namespace alphadot
