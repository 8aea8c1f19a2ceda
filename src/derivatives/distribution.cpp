#include "derivatives/distribution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/csv.hpp"

namespace alphadot {

namespace {

/// Share of a triangle's area where a linear function that is a <= b <= c at its corners is below t.
Real share_below(Real t, const std::array<Real, 3>& corners) {
  const auto [a, b, c] = corners;
  if (t <= a) return 0;
  if (t >= c) return 1;
  return t < b ? (t - a) * (t - a) / ((b - a) * (c - a)) : 1 - (c - t) * (c - t) / ((c - a) * (c - b));
}

}  // namespace

Slices::Slices(const Subdomain& domain, std::span<const std::size_t> patches, const Vec3& origin,
               const Vec3& direction, int count, const Communicator& comm)
    : domain_(domain),
      comm_(comm),
      is_counted_(domain.patch_names.size()),
      origin_(origin),
      direction_(direction) {
  for (const std::size_t patch : patches) is_counted_[patch] = true;
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  Real low = infinity, high = -infinity;
  for (const auto& face : domain_.boundary_faces) {
    if (!is_counted_[static_cast<std::size_t>(face.patch)]) continue;
    for (const Index point : face.points) {
      const Real at = dot(direction_, domain_.points[static_cast<std::size_t>(point)] - origin_);
      low = std::min(low, at);
      high = std::max(high, at);
    }
  }
  low = comm_.min(low);
  high = comm_.max(high);
  for (int i = 0; i <= count; ++i) ends_.push_back(low + (high - low) * i / count);
}

std::vector<Load> Slices::of(std::span<const Load> faces) const {
  const std::size_t count = ends_.size() - 1;
  const Real width = (ends_.back() - ends_.front()) / static_cast<Real>(count);
  std::vector<Load> out(count);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto& face = domain_.boundary_faces[i];
    if (!is_counted_[static_cast<std::size_t>(face.patch)]) continue;
    std::array<Real, 3> corners;
    for (std::size_t corner = 0; corner < 3; ++corner)
      corners[corner] =
          dot(direction_, domain_.points[static_cast<std::size_t>(face.points[corner])] - origin_);
    std::ranges::sort(corners);
    const auto slice_at = [&](Real t) {
      const Real slice = std::floor((t - ends_.front()) / width);
      return static_cast<std::size_t>(std::clamp<Real>(slice, 0, static_cast<Real>(count - 1)));
    };
    const std::size_t first = slice_at(corners[0]), last = slice_at(corners[2]);
    Real before = 0;
    for (std::size_t slice = first; slice <= last; ++slice) {
      const Real below = slice == last ? 1 : share_below(ends_[slice + 1], corners);
      out[slice] += (below - before) * faces[i];
      before = below;
    }
  }
  auto numbers = numbers_of(out);
  comm_.sum(std::span<Real>(numbers));
  return loads_of(numbers);
}

std::string distribution_csv(std::span<const Distribution> distributions, const std::string& along,
                             const std::string& note, const TableHead& head) {
  std::string out = csv_comment(head_text(head) + note + "\n") +
                    csv_line(std::array<std::string, 6>{"of", "name", along + "_from", along + "_to",
                                                        "per_length", "running"});
  const auto digits = [](Real number) { return fmt::format("{:.9g}", number); };
  for (const auto& [of, ends, quantities] : distributions)
    for (const auto& [name, values] : quantities) {
      if (std::ranges::all_of(values, [](Real value) { return value == 0; })) continue;
      Real running = 0;
      for (std::size_t i = 0; i < values.size(); ++i) {
        running += values[i];
        const Real width = ends[i + 1] - ends[i];
        out +=
            csv_line(std::array<std::string, 6>{of, name, digits(ends[i]), digits(ends[i + 1]),
                                                digits(values[i] / width), fmt::format("{:.17g}", running)});
      }
    }
  return out;
}

}  // namespace alphadot
