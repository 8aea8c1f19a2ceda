#include "space/influence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace alphadot {

namespace {

constexpr Real wider = 1.25;  // than the Mach cone, in the tangent

template <class Visitor>
void for_body_points(const Discretization& discretization, Visitor&& visit) {
  const Subdomain& domain = discretization.domain();
  for (const auto& face : domain.boundary_faces) {
    const auto kind = discretization.kind_of(face);
    if (kind == BoundaryKind::wall || kind == BoundaryKind::sting || kind == BoundaryKind::jet)
      for (const Index point : face.points) visit(domain.points[static_cast<std::size_t>(point)]);
  }
}

}  // namespace

Influence::Influence(const Discretization& discretization, const Vec3& wind, const Communicator& comm)
    : axis_(1 / norm(wind) * wind) {
  std::array<Real, 3> lower, upper;
  lower.fill(std::numeric_limits<Real>::infinity());
  upper.fill(-std::numeric_limits<Real>::infinity());
  for_body_points(discretization, [&](const Vec3& x) {
    for (int i = 0; i < 3; ++i) {
      lower[static_cast<std::size_t>(i)] = std::min(lower[static_cast<std::size_t>(i)], x[i]);
      upper[static_cast<std::size_t>(i)] = std::max(upper[static_cast<std::size_t>(i)], x[i]);
    }
  });
  comm.min(std::span<Real>(lower));
  comm.max(std::span<Real>(upper));
  if (lower[0] > upper[0]) lower = upper = {};
  const Vec3 low{lower[0], lower[1], lower[2]}, high{upper[0], upper[1], upper[2]};
  center_ = 0.5 * (low + high);
  body_size_ = norm(high - low);

  const Real mach = norm(wind);
  if (mach <= 1) {
    radius_ = 0.5 * body_size_;
    return;
  }
  const Real tangent = wider / std::sqrt(mach * mach - 1);
  cosine_ = 1 / std::sqrt(1 + tangent * tangent);
  sine_ = tangent * cosine_;
  Real foremost = std::numeric_limits<Real>::infinity();
  for_body_points(discretization, [&](const Vec3& x) {
    const Real along = dot(x - center_, axis_), aside = norm(x - center_ - along * axis_);
    foremost = std::min(foremost, along - aside / tangent);
  });
  foremost = comm.min(foremost);
  if (std::isfinite(foremost)) center_ += foremost * axis_;
}

Real Influence::distance(const Vec3& x) const {
  const Vec3 offset = x - center_;
  const Real along = dot(offset, axis_), aside = norm(offset - along * axis_);
  const bool beside_cone = along * cosine_ + aside * sine_ > 0;
  return std::max(beside_cone ? aside * cosine_ - along * sine_ : norm(offset) - radius_, Real{0});
}

}  // namespace alphadot
