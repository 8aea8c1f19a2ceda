#include "analysis/rational_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/csv.hpp"
#include "core/error.hpp"

namespace alphadot {

namespace {

using Complex = std::complex<Real>;
using Poles = std::vector<Complex>;

constexpr std::size_t fewest_frequencies = 4;

std::size_t states_of(const Poles& poles) {
  std::size_t out = 0;
  for (const Complex pole : poles) out += pole.imag() > 0 ? 2 : 1;
  return out;
}

/// x(s) of the states with the poles for u = 1.
Eigen::VectorXcd states_at(const Poles& poles, Complex s) {
  Eigen::VectorXcd out(static_cast<Eigen::Index>(states_of(poles)));
  Eigen::Index n = 0;
  for (const Complex pole : poles) {
    if (pole.imag() > 0) {
      const Complex one = Real{1} / (s - pole), other = Real{1} / (s - std::conj(pole));
      out[n++] = one + other;
      out[n++] = Complex{0, 1} * (one - other);
    } else {
      out[n++] = Real{1} / (s - pole);
    }
  }
  return out;
}

/// A and b of these states.
Eigen::MatrixXd matrix_of(const Poles& poles) {
  const auto size = static_cast<Eigen::Index>(states_of(poles));
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, size);
  Eigen::Index n = 0;
  for (const Complex pole : poles) {
    out(n, n) = pole.real();
    if (pole.imag() > 0) {
      out(n + 1, n + 1) = pole.real();
      out(n, n + 1) = pole.imag();
      out(n + 1, n) = -pole.imag();
    }
    n += pole.imag() > 0 ? 2 : 1;
  }
  return out;
}
Eigen::VectorXd input_of(const Poles& poles) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(states_of(poles)));
  Eigen::Index n = 0;
  for (const Complex pole : poles) {
    out[n] = pole.imag() > 0 ? 2 : 1;
    n += pole.imag() > 0 ? 2 : 1;
  }
  return out;
}

/// Weights of real and imaginary part at k.
std::array<Real, 2> weights_at(Real k) {
  return {1, std::max(Real{1}, 1 / (4 * k))};
}

class Fitting {
 public:
  Fitting(std::span<const Real> k, const std::vector<std::vector<Complex>>& responses)
      : k_(k), responses_(responses) {
    for (const auto& response : responses) {
      Real size = 0;
      for (const Complex value : response) size = std::max(size, std::abs(value));
      sizes_.push_back(size > 0 ? size : 1);
    }
  }

  /// Pairs whose imaginary parts spread over the frequencies, or one real pole more.
  Poles start(int states) const {
    Poles out;
    const int pairs = states / 2;
    for (int i = 0; i < pairs; ++i) {
      const Real at = k_.back() * (i + 0.5) / pairs;
      out.emplace_back(-0.3 * k_.back(), at);
    }
    if (states % 2 == 1) out.emplace_back(-0.5 * k_.back(), 0);
    return out;
  }

  /// The zeros of sigma(s) = 1 + sum of shares x_n(s), for which sigma y is fitted by the same poles.
  Poles moved(const Poles& poles) const {
    const auto states = static_cast<Eigen::Index>(states_of(poles)),
               loads = static_cast<Eigen::Index>(responses_.size()),
               frequencies = static_cast<Eigen::Index>(k_.size());
    Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(2 * loads * frequencies, loads * (states + 1) + states);
    Eigen::VectorXd right(2 * loads * frequencies);
    for (Eigen::Index load = 0; load < loads; ++load)
      for (Eigen::Index i = 0; i < frequencies; ++i) {
        const auto at = static_cast<std::size_t>(i), which = static_cast<std::size_t>(load);
        const Eigen::VectorXcd x = states_at(poles, {0, k_[at]});
        const Complex y = responses_[which][at] / sizes_[which];
        const auto weights = weights_at(k_[at]);
        for (Eigen::Index part = 0; part < 2; ++part) {
          const auto of = [&](Complex value) {
            return weights[static_cast<std::size_t>(part)] * (part == 0 ? value.real() : value.imag());
          };
          const Eigen::Index row = 2 * (load * frequencies + i) + part;
          for (Eigen::Index n = 0; n < states; ++n) {
            basis(row, load * (states + 1) + n) = of(x[n]);
            basis(row, loads * (states + 1) + n) = of(-y * x[n]);
          }
          basis(row, load * (states + 1) + states) = of(1);
          right[row] = of(y);
        }
      }
    const Eigen::VectorXd shares = solve(basis, right).tail(states);
    const Eigen::VectorXcd zeros =
        Eigen::EigenSolver<Eigen::MatrixXd>(matrix_of(poles) - input_of(poles) * shares.transpose(), false)
            .eigenvalues();
    // No slower than a hundredth of the lowest frequency and no faster than a hundred times the highest: what
    // is beyond is a constant.
    Poles out;
    for (const Complex zero : zeros) {
      if (zero.imag() < 0) continue;
      const Real decay = std::clamp(std::abs(zero.real()), 0.01 * k_.front(), 100 * k_.back());
      out.emplace_back(-decay, std::min(zero.imag(), 100 * k_.back()));
    }
    return out;
  }

  /// Shares and direct parts for these poles, and their errors.
  RationalFit with(const Poles& poles) const {
    RationalFit out{poles, {}, {}, {}, {}};
    const auto states = static_cast<Eigen::Index>(states_of(poles)),
               frequencies = static_cast<Eigen::Index>(k_.size());
    Eigen::MatrixXd basis(2 * frequencies, states + 1);
    for (Eigen::Index i = 0; i < frequencies; ++i) {
      const Real k = k_[static_cast<std::size_t>(i)];
      const Eigen::VectorXcd x = states_at(poles, {0, k});
      const auto weights = weights_at(k);
      basis.row(2 * i).head(states) = weights[0] * x.real().transpose();
      basis.row(2 * i + 1).head(states) = weights[1] * x.imag().transpose();
      basis(2 * i, states) = weights[0];
      basis(2 * i + 1, states) = 0;
    }
    for (std::size_t load = 0; load < responses_.size(); ++load) {
      Eigen::VectorXd right(2 * frequencies);
      for (Eigen::Index i = 0; i < frequencies; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const auto weights = weights_at(k_[at]);
        right[2 * i] = weights[0] * responses_[load][at].real();
        right[2 * i + 1] = weights[1] * responses_[load][at].imag();
      }
      const auto error_at = [&](const Eigen::VectorXd& parameters, Eigen::Index i) {
        const auto weights = weights_at(k_[static_cast<std::size_t>(i)]);
        const Eigen::VectorXd off = basis.middleRows(2 * i, 2) * parameters - right.segment(2 * i, 2);
        return std::hypot(off[0] / weights[0], off[1] / weights[1]) / sizes_[load];
      };
      const Eigen::VectorXd parameters = solve(basis, right);
      Real error = 0, between = 0;
      for (Eigen::Index i = 0; i < frequencies; ++i) error = std::max(error, error_at(parameters, i));
      for (Eigen::Index i = 1; i + 1 < frequencies; ++i) {
        Eigen::MatrixXd others = basis;
        Eigen::VectorXd other_right = right;
        others.middleRows(2 * i, 2).setZero();
        other_right.segment(2 * i, 2).setZero();
        between = std::max(between, error_at(solve(others, other_right), i));
      }
      out.shares.emplace_back(parameters.data(), parameters.data() + states);
      out.direct.push_back(parameters[states]);
      out.error.push_back(error);
      out.error_between.push_back(between);
    }
    return out;
  }

 private:
  /// By columns of one size, of which those that add nothing are left out.
  static Eigen::VectorXd solve(const Eigen::MatrixXd& basis, const Eigen::VectorXd& right) {
    Eigen::VectorXd sizes = basis.colwise().norm();
    for (Real& size : sizes)
      if (!(size > 0)) size = 1;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(basis * sizes.cwiseInverse().asDiagonal());
    factors.setThreshold(1e-10);
    return factors.solve(right).cwiseQuotient(sizes);
  }

  std::span<const Real> k_;
  const std::vector<std::vector<Complex>>& responses_;
  std::vector<Real> sizes_;
};

Real largest(const RationalFit& fit) {
  Real out = 0;
  for (const auto* errors : {&fit.error, &fit.error_between})
    for (const Real error : *errors) out = std::max(out, error);
  return out;
}

}  // namespace

std::size_t RationalFit::states() const {
  return states_of(poles);
}

std::complex<Real> RationalFit::at(std::size_t load, Real k) const {
  const Eigen::VectorXcd x = states_at(poles, {0, k});
  Complex out = direct[load];
  for (Eigen::Index n = 0; n < x.size(); ++n) out += shares[load][static_cast<std::size_t>(n)] * x[n];
  return out;
}

RationalFit fit_rational(std::span<const Real> k,
                         const std::vector<std::vector<std::complex<Real>>>& responses, Real tolerance,
                         int most_states) {
  if (k.size() < fewest_frequencies)
    throw InputError("", 0, "a rational fit needs responses at four frequencies or more");
  constexpr int rounds = 20;
  const Fitting fitting(k, responses);
  // Half of the numbers that a load's response is made of stay for the errors.
  const int most = std::min(most_states, static_cast<int>(k.size()) - 1);
  RationalFit best = fitting.with({});
  Real smallest = largest(best);
  for (int states = 1; states <= most && smallest > tolerance; ++states) {
    Poles poles = fitting.start(states);
    for (int round = 0; round < rounds; ++round) {
      poles = fitting.moved(poles);
      auto fit = fitting.with(poles);
      if (const Real error = largest(fit); error < smallest) {
        smallest = error;
        best = std::move(fit);
      }
    }
  }
  return best;
}

std::vector<VariableFit> rational_fits(std::span<const FrequencyRow> rows) {
  constexpr Real tolerance = 0.005;
  constexpr int most_states = 12;
  std::map<Variable, std::map<std::string, std::map<Real, Complex>>> responses;
  for (const auto& row : rows)
    if (row.part == "total")
      responses[row.variable][row.coefficient][row.k] = {row.in_phase.value, row.k * row.out_of_phase.value};
  std::vector<VariableFit> out;
  for (const auto& [variable, by_coefficient] : responses) {
    std::vector<Real> k;
    for (const auto& [at, value] : by_coefficient.begin()->second) k.push_back(at);
    if (k.size() < fewest_frequencies) continue;
    VariableFit fit{variable, {}, {}};
    std::vector<std::vector<Complex>> values;
    Real most = 0;
    const auto size_of = [](const std::map<Real, Complex>& response) {
      Real size = 0;
      for (const auto& [at, value] : response) size = std::max(size, std::abs(value));
      return size;
    };
    for (const auto& [coefficient, response] : by_coefficient) most = std::max(most, size_of(response));
    for (const auto& [coefficient, response] : by_coefficient) {
      constexpr Real nothing = 1e-3;  // beside the largest: what is left of symmetry
      if (size_of(response) < nothing * most) continue;
      fit.coefficients.push_back(coefficient);
      values.emplace_back();
      for (const auto& [at, value] : response) values.back().push_back(value);
    }
    if (values.empty()) continue;
    fit.fit = fit_rational(k, values, tolerance, most_states);
    out.push_back(std::move(fit));
  }
  return out;
}

std::string rational_fit_csv(std::span<const VariableFit> fits, const TableHead& head) {
  std::string out =
      csv_comment(head_text(head) +
                  "dx/dt* = A x + b u for u, the variable; load = c x + d u beside the steady one; t* = 2 V "
                  "t / length. "
                  "error: largest |fit - response| over the largest |response|, at the frequencies; "
                  "error_between: of a fit with the same poles that has not seen the frequency\n") +
      "variable,matrix,row,column,value\n";
  for (const auto& [variable, coefficients, fit] : fits) {
    const auto add = [&, by = variable](const char* matrix, const std::string& row, const std::string& column,
                                        Real value) {
      out += csv_line(std::vector<std::string>{std::string(name(by)), matrix, row, column,
                                               fmt::format("{:.17g}", value)});
    };
    const Eigen::MatrixXd a = matrix_of(fit.poles);
    const Eigen::VectorXd b = input_of(fit.poles);
    const auto number = [](Eigen::Index n) { return std::to_string(n + 1); };
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      for (Eigen::Index j = 0; j < a.cols(); ++j)
        if (a(i, j) != 0) add("A", number(i), number(j), a(i, j));
      if (b[i] != 0) add("b", number(i), "1", b[i]);
    }
    for (std::size_t load = 0; load < coefficients.size(); ++load) {
      for (std::size_t n = 0; n < fit.shares[load].size(); ++n)
        add("c", coefficients[load], std::to_string(n + 1), fit.shares[load][n]);
      add("d", coefficients[load], "1", fit.direct[load]);
      add("error", coefficients[load], "1", fit.error[load]);
      add("error_between", coefficients[load], "1", fit.error_between[load]);
    }
  }
  return out;
}

}  // namespace alphadot
