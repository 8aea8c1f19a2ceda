#include "motion/curve.hpp"

#include <algorithm>
#include <utility>

namespace alphadot {

Curve::Curve(std::vector<Real> x, std::vector<Real> y)
    : x_(std::move(x)), y_(std::move(y)), slope_(x_.size()) {
  const std::size_t last = x_.size() - 1;
  const auto chord = [&](std::size_t i) { return (y_[i + 1] - y_[i]) / (x_[i + 1] - x_[i]); };
  for (std::size_t i = 0; i <= last; ++i) {
    if (last == 1) {
      slope_[i] = chord(0);
      continue;
    }
    const std::size_t middle = std::clamp<std::size_t>(i, 1, last - 1);
    const Real before = x_[middle] - x_[middle - 1], after = x_[middle + 1] - x_[middle];
    const Real bend = (chord(middle) - chord(middle - 1)) / (before + after);  // half the second derivative
    const Real at_middle = chord(middle) - bend * after;
    slope_[i] = at_middle + 2 * bend * (x_[i] - x_[middle]);
  }
}

Curve::Place Curve::find(Real x) const {
  const auto next = std::upper_bound(x_.begin() + 1, x_.end() - 1, x);
  const auto piece = static_cast<std::size_t>(next - x_.begin()) - 1;
  const Real width = x_[piece + 1] - x_[piece];
  return {piece, width, (x - x_[piece]) / width};
}

Real Curve::value(Real x) const {
  if (x <= x_.front()) return y_.front();
  if (x >= x_.back()) return y_.back();
  const auto [i, h, s] = find(x);
  const Real r = 1 - s;
  return r * r * ((1 + 2 * s) * y_[i] + s * h * slope_[i]) +
         s * s * ((1 + 2 * r) * y_[i + 1] - r * h * slope_[i + 1]);
}

Real Curve::rate(Real x) const {
  if (x < x_.front() || x > x_.back()) return 0;
  const auto [i, h, s] = find(x);
  const Real r = 1 - s;
  return 6 * r * s * (y_[i + 1] - y_[i]) / h + r * (1 - 3 * s) * slope_[i] + s * (3 * s - 2) * slope_[i + 1];
}

}  // namespace alphadot
