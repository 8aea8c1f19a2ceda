#include "analysis/residual_forecast.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace alphadot {

namespace {
constexpr std::size_t half_window = 10;  // iterations
constexpr Real steadiness = 0.5;
}  // namespace

void ResidualForecast::add(Real seconds, Real orders) {
  points_.push_back({seconds, orders});
  if (points_.size() > 2 * half_window + 1) points_.erase(points_.begin());
}

Real ResidualForecast::seconds_to(Real orders) const {
  constexpr Real unknown = std::numeric_limits<Real>::quiet_NaN();
  if (points_.size() < 2 * half_window + 1) return unknown;
  const auto &first = points_.front(), &middle = points_[half_window], &last = points_.back();
  const auto [slow, fast] = std::minmax({middle.orders - first.orders, last.orders - middle.orders});
  if (!(slow > 0 && slow >= steadiness * fast)) return unknown;
  const Real seconds_per_order = (last.seconds - first.seconds) / (last.orders - first.orders);
  return std::max(seconds_per_order * (orders - last.orders), Real{0});
}

}  // namespace alphadot
