#include "derivatives/remaining_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alphadot {

namespace {

/// Earlier iterations that tell something have at least so many times the latest residual.
constexpr Real much_larger = 2;
/// No functional is less sensitive, in its scale, than this share of the most sensitive one.
constexpr Real of_others = 0.7;

/// How much a largest of so many samples is multiplied by.
Real safety(int samples) {
  return 5 + Real(5) / samples;
}

}  // namespace

std::vector<Real> remaining_error(std::span<const Real> norms, std::span<const std::vector<Real>> functionals,
                                  std::span<const Real> scales, Real relative_residual, Real orders,
                                  Real inherited) {
  constexpr Real unknown = std::numeric_limits<Real>::infinity(), too_little = 0.01;
  const Real last = norms.back();
  const auto& latest = functionals.back();
  std::vector<Real> out(latest.size(), unknown);
  if (relative_residual > std::max(too_little, std::pow(Real(10), -orders))) return out;
  int samples = 0;
  std::vector<Real> sensitivity(latest.size());
  for (std::size_t j = 0; j + 1 < norms.size(); ++j) {
    if (!(norms[j] >= much_larger * last) || norms[j] == 0) continue;
    ++samples;
    for (std::size_t i = 0; i < latest.size(); ++i)
      sensitivity[i] = std::max(sensitivity[i], std::abs(functionals[j][i] - latest[i]) / (norms[j] - last));
  }
  if (samples == 0 && last > 0) return out;
  Real most = 0;
  for (std::size_t i = 0; i < latest.size(); ++i)
    if (scales[i] > 0) most = std::max(most, sensitivity[i] / scales[i]);
  for (std::size_t i = 0; i < latest.size(); ++i) {
    if (samples == 0)
      out[i] = 0;
    else
      out[i] = safety(samples) * last * std::max(sensitivity[i], of_others * most * scales[i]);
    if (scales[i] > 0) out[i] += inherited * scales[i];
  }
  return out;
}

std::vector<Real> scales_of(const Load& total, Real body_size, std::size_t loads) {
  const Real force = std::max(norm(total.force), norm(total.moment) / body_size),
             moment = std::max(norm(total.moment), moment_arm * body_size * norm(total.force));
  const Load one{{force, force, force}, {moment, moment, moment}};
  return numbers_of(std::vector<Load>(loads, one));
}

Real relative_error(std::span<const Real> errors, std::span<const Real> scales) {
  Real out = 0;
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (scales[i] > 0) out = std::max(out, errors[i] / scales[i]);
  return out;
}

}  // namespace alphadot
