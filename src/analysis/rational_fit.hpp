// A few states that answer as the flow does, for simulations in time.
#pragma once

#include <complex>
#include <span>
#include <string>
#include <vector>

#include "analysis/frequency_table.hpp"

namespace alphadot {

/// Responses of several loads to one input over reduced frequency, y(i k), by common poles: y(s) = d + sum
/// over the states of c_n x_n(s) with dx/dt* = A x + b u, t* = 2 V t / l. All poles lie in the left half
/// plane; A has a pole, or for a pair [[re, im], [-im, re]], on its diagonal.
struct RationalFit {
  std::vector<std::complex<Real>> poles;  ///< of a pair only that with the positive imaginary part
  std::vector<std::vector<Real>> shares;  ///< [loads][states] c
  std::vector<Real> direct;               ///< [loads] d
  /// Largest |fit - response| of each load over the largest modulus of its response, at the frequencies
  /// themselves and, of each but the outermost, by a fit with the same poles that has not seen it.
  std::vector<Real> error, error_between;

  std::size_t states() const;
  std::complex<Real> at(std::size_t load, Real k) const;
};

/// `responses`: [loads][frequencies] at the k, which ascend. The least number of states, up to `most_states`
/// and to what the frequencies tell, whose errors are all below `tolerance`; else those with the smallest
/// error. By vector fitting: least squares with poles that move until they stay (B. Gustavsen & A. Semlyen,
/// IEEE Trans. Power Delivery 14, 1999, 1052); those that come out unstable are mirrored. At small k
/// imaginary parts count 1 / (4 k) times, so that the derivatives by rates are fitted as well as those by
/// angles. Throws InputError for fewer than four frequencies.
RationalFit fit_rational(std::span<const Real> k,
                         const std::vector<std::vector<std::complex<Real>>>& responses, Real tolerance,
                         int most_states);

/// Of every variable's loads on the whole configuration; none of fewer than four frequencies.
struct VariableFit {
  Variable variable;
  std::vector<std::string> coefficients;  ///< of the loads
  RationalFit fit;
};
std::vector<VariableFit> rational_fits(std::span<const FrequencyRow> rows);

/// Comment lines with the head, a header, full precision: a line a number of A, b, c and d, and of the
/// errors.
std::string rational_fit_csv(std::span<const VariableFit> fits, const TableHead& head);

}  // namespace alphadot
