#include "motion/gust.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "motion/column_table.hpp"

namespace alphadot {

GustTable parse_gust_table(std::string_view text, const std::string& file) {
  constexpr std::string_view columns[] = {"distance", "velocity"};
  const ColumnTable table(text, file, {"a gust", columns, "its front is at distance 0"});
  if (!table.has("velocity"))
    throw InputError(file, 0, "the table has no column velocity", "the columns are distance and velocity");
  return {table.column("distance"), table.column("velocity")};
}

Gust::Gust(const GustSettings& settings, Real speed, GustTable table)
    : settings_(settings), speed_(speed), table_(std::move(table)) {
  const auto& [x, w] = table_;
  for (std::size_t i = 0; i < x.size(); ++i)
    integrals_.push_back(i == 0 ? 0 : integrals_.back() + 0.5 * (x[i] - x[i - 1]) * (w[i] + w[i - 1]));
}

Real Gust::velocity(Real distance) const {
  constexpr Real share = 1e-4;  // of its length
  return distance < 0 ? 0 : mean(distance, share * settings_.length);
}

Real Gust::mean(Real distance, Real half_width) const {
  // Where the interval is short its integral's differences lose digits: no shorter than this share.
  const Real half = std::max(half_width, 1e-6 * std::max(std::abs(distance), settings_.length));
  return speed_ * (integral(distance + half) - integral(distance - half)) / (2 * half);
}

Real Gust::integral(Real distance) const {
  if (distance <= 0) return 0;
  const Real length = settings_.length, wave = 2 * pi / length;
  switch (settings_.kind) {
    case GustKind::none:
      return 0;
    case GustKind::sharp:
      return settings_.velocity * distance;
    case GustKind::one_minus_cosine: {
      const Real inside = std::min(distance, length);
      return settings_.velocity * 0.5 * (inside - std::sin(wave * inside) / wave);
    }
    case GustKind::harmonic:
      return settings_.velocity * (1 - std::cos(wave * distance)) / wave;
    case GustKind::table:
      break;
  }
  const auto& [x, w] = table_;
  const auto next = std::ranges::upper_bound(x, distance);
  if (next == x.end()) return integrals_.back() + w.back() * (distance - x.back());
  const auto i = static_cast<std::size_t>(next - x.begin()) - 1;
  const Real way = distance - x[i];
  return integrals_[i] + way * (w[i] + 0.5 * way * (w[i + 1] - w[i]) / (x[i + 1] - x[i]));
}

}  // namespace alphadot
